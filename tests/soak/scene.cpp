#include "soak/scene.hpp"

#include "support/sphere_grid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace levelray::test {

double uniform(Random& random, double low, double high) {
  // 53 bits, not the library's distribution, so that every standard library gives the same rays.
  return low + (high - low) * (static_cast<double>(random() >> 11) * 0x1p-53);
}

namespace {

Vec3d unit_vector(Random& random) {
  for (;;) {
    const Vec3d d(uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 1));
    const double length = d.length();
    if (length > 0.1 && length <= 1) return d / length;
  }
}

double box_distance(const Vec3d& q, const Vec3d& half) {
  const double x = std::fabs(q.x) - half.x, y = std::fabs(q.y) - half.y, z = std::fabs(q.z) - half.z;
  return Vec3d(std::max(x, 0.0), std::max(y, 0.0), std::max(z, 0.0)).length() +
         std::min(std::max(x, std::max(y, z)), 0.0);
}

} // namespace

BlockGrid random_shape(std::size_t kind, Random& random) {
  // Everything in voxels about the centre, then scaled.
  const Vec3d w = unit_vector(random),
              u = w.cross(std::fabs(w.x) < 0.8 ? Vec3d(1, 0, 0) : Vec3d(0, 1, 0)).normalized(),
              v = w.cross(u);
  const auto local = [=](const Vec3d& q) { return Vec3d(q.dot(u), q.dot(v), q.dot(w)); };
  const double voxels[] = {1, 1, 0.37, 1e-3, 1e3, 0x1p-7, 2.5};
  const double voxel = voxels[random() % std::size(voxels)];
  const double centre_scale = random() % 4 == 0 ? 0 : random() % 4 == 0 ? 1000 : 20;
  Vec3d centre(uniform(random, -1, 1) * centre_scale, uniform(random, -1, 1) * centre_scale,
               uniform(random, -1, 1) * centre_scale);
  if (random() % 3 == 0) centre = Vec3d(std::round(centre.x), std::round(centre.y), std::round(centre.z));
  const Vec3d origin = random() % 2 ? Vec3d(0, 0, 0) : unit_vector(random) * (voxel * 30);

  const std::uint64_t salt = random();
  const auto noise = [=](const Vec3d& p) { // by the nearest sample, uniform in [-1, 1)
    std::uint64_t x = salt;
    for (int a = 0; a < 3; ++a) {
      x ^= static_cast<std::uint64_t>(std::llround(p[a]) + 0x100000) * 0x9E3779B97F4A7C15u;
      x ^= x >> 29, x *= 0xBF58476D1CE4E5B9u, x ^= x >> 32;
    }
    return static_cast<double>(x >> 11) * 0x1p-52 - 1;
  };
  double extent = 0;
  const auto sampled = [&](auto field) {
    // `field` in voxels about the centre.
    const double e = extent + 4;
    const Vec3d half(e, e, e), middle = origin + centre * voxel;
    return sample_grid([&](const Vec3d& p) { return field((p - middle) / voxel) * voxel; }, voxel, 3,
                       Box3d(middle - half * voxel, middle + half * voxel), origin);
  };
  switch (kind) {
  case 0: {
    const double radius = extent = random() % 2 ? std::floor(uniform(random, 8, 24)) : uniform(random, 8, 24);
    return sampled([=](const Vec3d& q) { return q.length() - radius; });
  }
  case 1: {
    const double radius = extent = uniform(random, 0.3, 3);
    return sampled([=](const Vec3d& q) { return q.length() - radius; });
  }
  case 2: {
    const double big = uniform(random, 8, 18), tube = uniform(random, 0.5, 3);
    extent = big + tube;
    return sampled([=](const Vec3d& q) {
      const Vec3d p = local(q);
      return std::hypot(std::hypot(p.x, p.y) - big, p.z) - tube;
    });
  }
  case 3: {
    const Vec3d half(14, 14, uniform(random, 0.05, 1));
    extent = 20;
    return sampled([=](const Vec3d& q) { return box_distance(local(q), half); });
  }
  case 4: {
    const double radius = uniform(random, 6, 20), half = uniform(random, 0.3, 0.8);
    extent = radius + half;
    return sampled([=](const Vec3d& q) { return std::fabs(q.length() - radius) - half; });
  }
  case 5: {
    const double scale = uniform(random, 0.25, 0.45), half = uniform(random, 0.4, 1);
    extent = 19;
    return sampled([=](const Vec3d& q) {
      const Vec3d p = local(q) * scale;
      const double g =
          std::sin(p.x) * std::cos(p.y) + std::sin(p.y) * std::cos(p.z) + std::sin(p.z) * std::cos(p.x);
      return std::max(std::fabs(g) / (scale * 1.5) - half, q.length() - 18);
    });
  }
  case 6: {
    const Vec3d half(uniform(random, 3, 12), uniform(random, 3, 12), uniform(random, 3, 12));
    extent = half.length();
    return sampled([=](const Vec3d& q) { return box_distance(local(q), half); });
  }
  case 7: {
    const double angle = uniform(random, 0.05, 0.8), height = 18;
    extent = 20;
    return sampled([=](const Vec3d& q) { // a tip at the centre, cut off at `height`; no distance near its rim
      const Vec3d p = local(q);
      const double r = std::hypot(p.x, p.y);
      const double side = r * std::cos(angle) - p.z * std::sin(angle);
      const double tip = p.z * std::cos(angle) + r * std::sin(angle) < 0 ? p.length() : side;
      return std::max(tip, p.z - height * std::cos(angle));
    });
  }
  case 8: {
    const double radius = std::floor(uniform(random, 4, 10)),
                 gap = random() % 3 ? 0 : uniform(random, -0.5, 0.5);
    extent = 2 * radius + 1;
    return sampled([=](const Vec3d& q) {
      const Vec3d off = Vec3d(radius + gap / 2, 0, 0);
      return std::min((q - off).length(), (q + off).length()) - radius;
    });
  }
  case 9:
    extent = 10;
    return sampled([=](const Vec3d& q) { return q.length() < 10 ? noise(q) : 1; });
  case 10:
    extent = 8;
    return sampled([=](const Vec3d& q) {
      return q.length() < 8 ? std::floor(noise(q) * 1.5 + 0.5) : 1; // -1, 0, 1
    });
  default: {
    const Vec3d half(std::floor(uniform(random, 3, 12)), std::floor(uniform(random, 3, 12)),
                     random() % 2 ? 0.5 : std::floor(uniform(random, 3, 12)));
    extent = half.length();
    return sampled([=](const Vec3d& q) { return box_distance(q, half); });
  }
  }
}

RayMaker::RayMaker(const LevelSet& level_set, const RayOracle& oracle, Random& random)
    : level_set_(level_set), grid_(level_set.grid()), random_(random) {
  const BlockGrid& grid = grid_;
  const Box3i samples = grid.active_bounds();
  box_ = Box3d(grid.transform.to_world(Vec3d(samples.min)), grid.transform.to_world(Vec3d(samples.max)));
  reach_ = 1.5 * (box_.max - box_.min).length();
  for (int i = 0; i < 4000 && surface_.size() < 300; ++i) {
    const WorldRay ray = through(point_in_box(), direction());
    for (const OracleRoot& root : oracle.ask(ray).roots)
      surface_.push_back(ray.at(static_cast<double>(root.t)));
  }
  if (surface_.empty()) surface_.push_back((box_.min + box_.max) * 0.5);
}

Vec3d RayMaker::point_in_box() {
  return Vec3d(uniform(random_, box_.min.x, box_.max.x), uniform(random_, box_.min.y, box_.max.y),
               uniform(random_, box_.min.z, box_.max.z));
}

Vec3d RayMaker::direction() {
  return unit_vector(random_);
}

Vec3d RayMaker::near_surface() {
  return grid_.transform.to_voxel(surface_[random_() % surface_.size()]);
}

WorldRay RayMaker::through(const Vec3d& world_point, const Vec3d& d) {
  WorldRay ray;
  ray.direction = d;
  ray.origin = world_point - d * (reach_ / d.length());
  return ray;
}

// By one unit in the last place, or not, per coordinate; none at all half of the time.
void RayMaker::shake(Vec3d& v) {
  if (random_() % 2) return;
  for (int a = 0; a < 3; ++a) {
    const auto way = random_() % 3;
    if (way) v[a] = std::nextafter(v[a], way == 1 ? 1e300 : -1e300);
  }
}

// The last ray of a bundle of parallels that still hits, or the first that does not, to the last bit of how
// far it is moved: which that is, the tracer says; what is true of it, the oracle.
WorldRay RayMaker::silhouette() {
  const Vec3d p = surface_[random_() % surface_.size()], d = direction();
  const Vec3d sideways = d.cross(direction()).normalized() * reach_;
  double low = 0, high = 1;
  const auto ray_at = [&](double x) { return through(p + sideways * x, d); };
  const bool first = any_hit(level_set_, ray_at(0));
  for (int step = 0; step < 52; ++step) {
    const double middle = 0.5 * (low + high);
    (any_hit(level_set_, ray_at(middle)) == first ? low : high) = middle;
  }
  return ray_at(random_() % 2 ? low : high);
}

std::size_t RayMaker::any_kind() {
  const auto choice = random_() % 64;
  return choice < 20 ? 0 : choice < 22 ? 7 : choice < 26 ? 6 : 1 + choice % 11;
}

WorldRay RayMaker::make(std::size_t kind) {
  const auto round_axes = [&](Vec3d v, int how_many) { // `how_many` random coordinates to the next integer
    int axis = static_cast<int>(random_() % 3);
    for (int i = 0; i < how_many; ++i, axis = (axis + 1) % 3) v[axis] = std::round(v[axis]);
    return grid_.transform.to_world(v);
  };
  const auto perpendicular = [&](const Vec3d& n) {
    Vec3d d = n.cross(direction());
    return d.length() > 1e-3 ? d.normalized() : direction();
  };
  WorldRay ray;
  switch (kind) {
  case 0:
    return through(point_in_box(), direction());
  case 1:
  case 2:
  case 3: {
    const Vec3d target = round_axes(near_surface(), 4 - static_cast<int>(kind));
    ray = through(target, direction());
    if (random_() % 2) ray.direction = target - ray.origin; // goes through the target nearly to the last bit
    break;
  }
  case 4: {
    Vec3d d(0, 0, 0);
    d[static_cast<int>(random_() % 3)] = random_() % 2 ? 1 : -1;
    ray = through(round_axes(near_surface(), static_cast<int>(random_() % 4)), d);
    break;
  }
  case 5: {
    const auto digit = [&] { return static_cast<double>(random_() % 3) - 1; };
    Vec3d d(digit(), digit(), digit());
    if (d == Vec3d(0, 0, 0)) d = Vec3d(1, 1, 1);
    ray = through(round_axes(near_surface(), 3), d);
    break;
  }
  case 6: {
    // Tangent to the interpolant at a point of it: differences of f's signs do for a normal no better than
    // its samples', so take the gradient of the cell's samples by central differences.
    const Vec3d p = near_surface();
    const auto f = [&](int x, int y, int z) {
      return static_cast<double>(grid_.value(static_cast<int>(std::lround(p.x)) + x,
                                             static_cast<int>(std::lround(p.y)) + y,
                                             static_cast<int>(std::lround(p.z)) + z));
    };
    const Vec3d n(f(1, 0, 0) - f(-1, 0, 0), f(0, 1, 0) - f(0, -1, 0), f(0, 0, 1) - f(0, 0, -1));
    const double off = random_() % 2 ? 0 : std::pow(10, uniform(random_, -16, -2)) * (random_() % 2 ? 1 : -1);
    const Vec3d unit = n.length() > 0 ? n.normalized() : Vec3d(0, 0, 1);
    ray = through(grid_.transform.to_world(p + unit * off), perpendicular(unit));
    break;
  }
  case 7:
    ray = silhouette();
    break;
  case 8:
    ray.origin = surface_[random_() % surface_.size()];
    if (random_() % 2) ray.origin = round_axes(grid_.transform.to_voxel(ray.origin), 3);
    ray.direction = direction();
    break;
  case 9:
    ray.origin = random_() % 3 ? point_in_box() : round_axes(grid_.transform.to_voxel(point_in_box()), 3);
    ray.direction = direction();
    break;
  case 10: {
    const Vec3d p = surface_[random_() % surface_.size()];
    ray = through(p, direction());
    // Ends at the surface, or begins there, or about there.
    const double t = reach_ + (random_() % 2 ? 0 : uniform(random_, -0.01, 0.01) * reach_);
    (random_() % 2 ? ray.t_max : ray.t_min) = t;
    break;
  }
  default: {
    Vec3d d = direction();
    const int axis = static_cast<int>(random_() % 3);
    if (random_() % 2) d[axis] *= std::pow(2, -static_cast<double>(random_() % 80));
    if (random_() % 3 == 0) d[(axis + 1) % 3] = 0;
    ray = through(random_() % 2 ? round_axes(near_surface(), 3) : point_in_box(), d);
    ray.direction *= std::pow(2, static_cast<double>(random_() % 120) - 60);
    if (random_() % 3 == 0)
      ray.origin -= d * (reach_ * std::pow(10, uniform(random_, 0, 4))); // from far away
    break;
  }
  }
  shake(ray.origin);
  shake(ray.direction);
  return ray;
}

} // namespace levelray::test
