#include "levelray/measure/ray_trial.hpp"

#include "levelray/intersect/intersectors.hpp"
#include "levelray/trace/certified_hit.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace levelray {

RayTrial::RayTrial(const BlockGrid& grid, std::string name, const ExtremeSettings& settings,
                   ExtremeTally& tally, double rounding, int surface_rays)
    : grid_(grid), name_(std::move(name)), settings_(settings), tally_(tally), level_set_(grid),
      judge_(grid, rounding), random_(settings.seed) {
  const Box3i samples = grid.active_bounds();
  if (samples.isEmpty()) {
    box_ = Box3d(grid.transform.origin, grid.transform.origin);
    return;
  }
  box_ = Box3d(grid.transform.to_world(Vec3d(samples.min)), grid.transform.to_world(Vec3d(samples.max)));
  for (int i = 0; i < surface_rays && surface_.size() < 100; ++i) {
    const WorldRay ray = random_ray();
    const RayAnswer answer = judge_.ask(ray);
    if (answer.is_clear() && answer.latest < std::numeric_limits<Extended>::infinity())
      surface_.push_back(ray.at(static_cast<double>(answer.root)));
  }
}

double RayTrial::uniform(double low, double high) {
  // 53 bits, not the library's distribution, so that every standard library gives the same rays.
  return low + (high - low) * (static_cast<double>(random_() >> 11) * 0x1p-53);
}

Vec3d RayTrial::random_direction() {
  for (;;) {
    const Vec3d d(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1));
    const double length = d.length();
    if (length > 0.1 && length <= 1) return d / length;
  }
}

Vec3d RayTrial::random_place() {
  return Vec3d(uniform(box_.min.x, box_.max.x), uniform(box_.min.y, box_.max.y),
               uniform(box_.min.z, box_.max.z));
}

WorldRay RayTrial::random_ray() {
  WorldRay ray;
  ray.direction = random_direction();
  // Not length(), which is 0 for sizes below 1e-160.
  const Vec3d size = box_.max - box_.min;
  ray.origin = random_place() - ray.direction * (2 * (size.x + size.y + size.z));
  return ray;
}

std::string RayTrial::describe(const WorldRay& ray) const {
  const auto vector = [](const Vec3d& v) { return fmt::format("({:a}, {:a}, {:a})", v.x, v.y, v.z); };
  return fmt::format("{}: o {} d {} t {:a} to {:a}", name_, vector(ray.origin), vector(ray.direction),
                     ray.t_min, ray.t_max);
}

WorldRay RayTrial::ray_of_kind(int kind) {
  WorldRay ray = random_ray();
  if (surface_.empty()) return ray;
  const Vec3d near = surface_[random_() % surface_.size()];
  const double h = grid_.transform.voxel_size, reach = (ray.origin - near).length();
  const auto rounded = [&](int axes) { // so many coordinates to the lattice
    Vec3d voxel = grid_.transform.to_voxel(near);
    for (int i = 0, a = static_cast<int>(random_() % 3); i < axes; ++i, a = (a + 1) % 3)
      voxel[a] = std::round(voxel[a]);
    return grid_.transform.to_world(voxel);
  };
  const auto towards = [&](const Vec3d& target, const Vec3d& d) {
    ray.direction = d;
    ray.origin = target - d * (reach / d.length());
  };
  const auto digit = [&] { return static_cast<double>(random_() % 3) - 1; };
  switch (kind) {
  case 0:
    break;
  case 1: { // along an axis, on the lattice or off it
    Vec3d d(0, 0, 0);
    d[static_cast<int>(random_() % 3)] = random_() % 2 ? 1 : -1;
    towards(rounded(static_cast<int>(random_() % 4)), d);
    break;
  }
  case 2: { // along diagonals through vertices
    Vec3d d(digit(), digit(), digit());
    if (d == Vec3d(0, 0, 0)) d = Vec3d(1, 1, -1);
    towards(rounded(3), d);
    break;
  }
  case 3: // through a vertex, an edge, a face
    towards(rounded(1 + static_cast<int>(random_() % 3)), random_direction());
    break;
  case 4: { // tangent to the samples' gradient at the surface
    const Vec3d p = grid_.transform.to_voxel(near);
    const int i = static_cast<int>(std::lround(p.x)), j = static_cast<int>(std::lround(p.y)),
              k = static_cast<int>(std::lround(p.z));
    const auto difference = [&](int x, int y, int z) {
      return (double{grid_.value(i + x, j + y, k + z)} - double{grid_.value(i - x, j - y, k - z)}) /
             double{grid_.background};
    };
    const Vec3d n(difference(1, 0, 0), difference(0, 1, 0), difference(0, 0, 1));
    const Vec3d d = n.cross(random_direction());
    if (!(d.length() > 1e-3)) break;
    const double off = random_() % 2 ? 0 : std::pow(10, uniform(-16, -2)) * (random_() % 2 ? h : -h);
    towards(near + n.normalized() * off, d.normalized());
    break;
  }
  case 5:
    ray.origin = random_place();
    break; // from anywhere in the band's box
  case 6:  // from the surface, or a vertex beside it
    ray.origin = random_() % 2 ? near : rounded(3);
    break;
  default: // cut off at the surface
    towards(near, random_direction());
    (random_() % 2 ? ray.t_max : ray.t_min) = reach + (random_() % 2 ? 0 : uniform(-h, h));
  }
  if (random_() % 3 == 0)
    for (int a = 0; a < 3; ++a) {
      const auto way = random_() % 3;
      double& x = random_() % 2 ? ray.origin[a] : ray.direction[a];
      if (way) x = std::nextafter(x, way == 1 ? 1e300 : -1e300);
    }
  return ray;
}

void RayTrial::judge_all_kinds(std::size_t count) {
  for (int kind = 0; kind < 8; ++kind)
    for (std::size_t i = 0; i < count; ++i) judge(ray_of_kind(kind));
}

void RayTrial::judge_nothing(const WorldRay& ray) {
  tally_.add();
  const auto quiet = [&](bool right, const char* what) {
    tally_.check(right, [&] { return describe(ray) + ": " + what; });
  };
  for (const std::string& name : method_names<Intersectors>()) {
    quiet(!closest_hit(level_set_, ray, name), "closest_hit finds something");
    quiet(!any_hit(level_set_, ray, name), "any_hit finds something");
  }
  std::vector<SurfacePlace> places;
  const EndSides sides = all_hits(level_set_, ray, places);
  quiet(places.empty() && sides.first == 1 && sides.last == 1, "all_hits finds something");
  quiet(!farthest_hit(level_set_, ray), "farthest_hit finds something");
}

void RayTrial::judge(const WorldRay& ray) {
  tally_.add();
  const RayAnswer answer = judge_.ask(ray);
  const Hit hit = closest_hit(level_set_, ray, settings_.intersector);
  const auto wrong = [&](const std::string& what) {
    return describe(ray) + ": " + what +
           fmt::format("; right is a hit from {:a} to {:a}, side {}", static_cast<double>(answer.earliest),
                       static_cast<double>(answer.latest), answer.side);
  };
  judge_others(ray);
  if (!hit) {
    tally_.check(!(answer.latest < std::numeric_limits<Extended>::infinity()),
                 [&] { return wrong("misses the surface"); });
    return;
  }
  // See the header. Places are rounded before the solver sees them, along the ray too.
  const Extended t = hit.t,
                 tolerance = (0x1p-36L + answer.place_error) * answer.per_voxel + 8 * 0x1p-53L * std::fabs(t);
  const auto at = [&](const char* what) { return wrong(fmt::format("{} {:a}", what, hit.t)); };
  tally_.check(hit.t >= ray.t_min && hit.t <= ray.t_max && hit.t_outside <= hit.t &&
                   hit.t_outside >= ray.t_min,
               [&] { return at("hits beyond its interval, or begins secondary rays there, at"); });
  if (!tally_.check(t >= answer.earliest - tolerance, [&] { return at("hits before the surface, at"); }))
    return;
  if (!tally_.check(t <= answer.latest + tolerance,
                    [&] { return at("hits another surface than the first, at"); }))
    return;
  if (answer.is_clear()) tally_.error(static_cast<double>(std::fabs(t - answer.root) / answer.per_voxel));
  if (answer.side) {
    tally_.check(hit.from_inside == (answer.side < 0),
                 [&] { return at("is wrong about its beginning, at"); });
    // Within 2^14 voxels: place_error is 2^-48 of the distances.
    if (safe_places_ && hit.t_outside > ray.t_min && answer.place_error <= 0x1p-33L)
      tally_.check(judge_.sign_at(ray, hit.t_outside) == answer.side,
                   [&] { return wrong(fmt::format("t_outside {:a} is on the other side", hit.t_outside)); });
  }
  if (settings_.intersector != Exact::name) return;
  judge_places(ray, hit, answer);
  judge_certificate(ray, hit, answer);
}

void RayTrial::judge_places(const WorldRay& ray, const Hit& hit, const RayAnswer& answer) {
  std::vector<SurfacePlace> places;
  const EndSides sides = all_hits(level_set_, ray, places);
  const auto check = [&](bool right, const char* what) {
    tally_.check(right, [&] { return describe(ray) + ": " + what; });
  };
  check(!places.empty() && places[0].t == hit.t && places[0].cell == hit.cell,
        "the first of all hits is not the closest hit");
  std::size_t crossings = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    crossings += places[i].kind != PlaceKind::touch;
    check(places[i].t >= ray.t_min && places[i].t <= ray.t_max && (!i || places[i].t >= places[i - 1].t),
          "all hits are out of order, or beyond the interval");
  }
  const std::optional<SurfacePlace> last = farthest_hit(level_set_, ray);
  check(!places.empty() && last && last->t == places.back().t && last->kind == places.back().kind,
        "the farthest hit is not the last of all");
  if (!answer.side || !std::isfinite(ray.t_max)) {
    if (answer.side && !std::isfinite(ray.t_max)) // the outside is all around
      check((crossings % 2 != 0) == (answer.side < 0), "the parity of crossings is not the change of sign");
    return;
  }
  check(sides.first == answer.side, "all_hits is wrong about the beginning's side");
  Extended margin = 0;
  const Extended end = judge_.value_at(ray, ray.t_max, margin);
  if (std::fabs(end) > margin) {
    check(sides.last == (end > 0 ? 1 : -1), "all_hits is wrong about the end's side");
    check((crossings % 2 != 0) == ((end > 0) != (answer.side > 0)),
          "the parity of crossings is not the change of sign");
  }
}

void RayTrial::judge_certificate(const WorldRay& ray, const Hit& hit, const RayAnswer& answer) {
  const CertifiedHit proven = certify(level_set_, ray, hit);
  const auto check = [&](bool right, const char* what) {
    tally_.check(right, [&] {
      return describe(ray) + fmt::format(": hit {:a}: {}: t_lo {:a} t_hi {:a} error {:a}", hit.t, what,
                                         proven.t_lo, proven.t_hi, proven.error);
    });
  };
  check(proven.proof != Proof::refuted && proven.proof != Proof::miss, "certify refutes it");
  const int side = hit.from_inside ? -1 : 1;
  if (proven.proof == Proof::crossing) {
    check(judge_.sign_at(ray, proven.t_lo) == side, "certified, but f(t_lo) > 0 is false");
    check(judge_.sign_at(ray, proven.t_hi) != side, "certified, but f(t_hi) <= 0 is false");
  }
  // The judge knows the root to 2^-58 of the values' size, which moves a clear one by no more than the 2^-20
  // voxel that such a change of 2^-44 does, in proportion: 2^-34 voxel.
  if (proven.proof == Proof::crossing && answer.is_clear())
    check(std::fabs(Extended{hit.t} - answer.root) <= Extended{proven.error} + 0x1p-34L * answer.per_voxel,
          "the first root is farther off than certified");
}

void RayTrial::judge_others(const WorldRay& ray) {
  for (const std::string& name : method_names<Intersectors>()) {
    const Hit hit = closest_hit(level_set_, ray, name);
    tally_.check(any_hit(level_set_, ray, name) == bool(hit),
                 [&] { return describe(ray) + ": any_hit and closest_hit disagree by " + name; });
    if (hit)
      tally_.check(hit.t >= ray.t_min && hit.t <= ray.t_max && hit.t_outside <= hit.t,
                   [&] { return describe(ray) + ": " + name + fmt::format(" hits at {:a}", hit.t); });
  }
}

} // namespace levelray
