#include "levelray/measure/surface_truth.hpp"

#include "levelray/trace/all_hits.hpp"
#include "levelray/trace/field_probe.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace levelray {

namespace {

// Unit length, or zero.
Vec3d direction_of(const Vec3d& v) {
  const double length = v.length();
  return length > 0 ? v / length : Vec3d(0, 0, 0);
}

} // namespace

MeshTruth::MeshTruth(const PreparedMesh& mesh, double thicken)
    : mesh_(mesh), bvh_(mesh.mesh), thicken_(thicken), open_vertices_(mesh.mesh.vertices.size(), false) {
  for (auto [a, b] : mesh.open_edges) {
    open_vertices_[a] = open_vertices_[b] = true;
    open_edges_.push_back({std::min(a, b), std::max(a, b)});
  }
  std::sort(open_edges_.begin(), open_edges_.end());
}

Box3d MeshTruth::bounds() const {
  Box3d box = mesh_.report.bounds;
  box.min -= Vec3d(thicken_);
  box.max += Vec3d(thicken_);
  return box;
}

Vec3d MeshTruth::face_normal(std::uint32_t triangle) const {
  const Triangle& t = mesh_.mesh.triangles[triangle];
  const std::vector<Vec3d>& v = mesh_.mesh.vertices;
  return direction_of((v[t[1]] - v[t[0]]).cross(v[t[2]] - v[t[0]]));
}

std::optional<TruePlace> MeshTruth::first_place(const WorldRay& ray) const {
  if (thicken_ > 0) return first_of_sheet(ray);
  const auto hit = bvh_.first_hit(ray);
  if (!hit || !hit->front) return {};
  return TruePlace{hit->t, ray.at(hit->t), face_normal(hit->triangle)};
}

// Sphere tracing (Hart 1996, section 2) of the distance to the mesh less the radius, a field with slope 1 at
// most: no step passes the sheet. A ray that comes within 2^-20 of the radius has met it; one that comes near
// without end, within 2^-20, has too. 4096 steps end what glides along without coming so near: nothing.
std::optional<TruePlace> MeshTruth::first_of_sheet(const WorldRay& ray) const {
  const Box3d box = bounds();
  const Vec3d centre = box.center();
  const double radius = (box.max - centre).length();
  const double middle = (centre - ray.origin).dot(ray.direction);
  const Vec3d off = ray.at(middle) - centre;
  if (!(off.length() < radius)) return {};
  const double half = std::sqrt(radius * radius - off.dot(off));
  double t = std::max(ray.t_min, middle - half);
  for (int step = 0; step < 4096 && t < middle + half; ++step) {
    const Vec3d p = ray.at(t);
    const MeshPoint nearest = *bvh_.closest_point(p);
    const double outside = std::sqrt(nearest.distance_squared) - thicken_;
    if (outside <= 0x1p-20 * thicken_)
      return step == 0 ? std::optional<TruePlace>() : TruePlace{t, p, direction_of(p - nearest.point)};
    t += outside;
  }
  return {};
}

bool MeshTruth::is_open(const MeshPoint& nearest) const {
  if (open_edges_.empty() || nearest.feature == feature_face) return false;
  const Triangle& t = mesh_.mesh.triangles[nearest.triangle];
  if (nearest.feature < feature_edge) return open_vertices_[t[static_cast<std::size_t>(nearest.feature)]];
  const auto k = static_cast<std::size_t>(nearest.feature - feature_edge);
  const std::uint32_t a = t[k], b = t[(k + 1) % 3];
  return std::binary_search(open_edges_.begin(), open_edges_.end(),
                            std::array<std::uint32_t, 2>{std::min(a, b), std::max(a, b)});
}

double MeshTruth::distance(const Vec3d& p, double at_most) const {
  // The ball grows by the rounding of its radius; where that is not enough, all of space is searched.
  std::optional<MeshPoint> found;
  if (std::isfinite(at_most)) found = bvh_.closest_point(p, (at_most + thicken_) * (1 + 0x1p-40));
  const MeshPoint nearest = found ? *found : *bvh_.closest_point(p);
  const double d = std::sqrt(nearest.distance_squared);
  if (thicken_ > 0) return std::fabs(d - thicken_);
  return is_open(nearest) ? std::numeric_limits<double>::quiet_NaN() : d;
}

Vec3d MeshTruth::normal(const Vec3d& p) const {
  const MeshPoint nearest = *bvh_.closest_point(p);
  return thicken_ > 0 ? direction_of(p - nearest.point) : face_normal(nearest.triangle);
}

GridTruth::GridTruth(const LevelSet& level_set) : level_set_(level_set) {
  const BlockGrid& grid = level_set.grid();
  const Box3i samples = grid.active_bounds();
  if (samples.isEmpty()) return;
  bounds_ = {grid.transform.to_world(Vec3d(samples.min)), grid.transform.to_world(Vec3d(samples.max))};
}

std::optional<TruePlace> GridTruth::first_place(const WorldRay& ray) const {
  const Hit hit = closest_hit(level_set_, ray);
  if (!hit) return {};
  const Vec3d p = ray.at(hit.t);
  return TruePlace{hit.t, p, normal(p)};
}

double GridTruth::distance(const Vec3d& p, double at_most) const {
  const double across = bounds_.isEmpty() ? 0 : bounds_.size().length();
  return distance_to_zero_set(level_set_, p, Vec3d(0, 0, 0), std::min(at_most, across));
}

Vec3d GridTruth::normal(const Vec3d& p) const {
  return direction_of(probe_field(level_set_.grid(), p).gradient);
}

double distance_to_zero_set(const LevelSet& level_set, const Vec3d& p, const Vec3d& normal, double bound) {
  const BlockGrid& grid = level_set.grid();
  std::vector<SurfacePlace> places;
  const auto look_along = [&](const Vec3d& direction) {
    if (!(direction.length() > 0) || !(bound > 0)) return;
    WorldRay ray;
    ray.origin = p, ray.direction = direction;
    ray.t_min = -bound, ray.t_max = bound;
    all_hits(level_set, ray, places);
    for (const SurfacePlace& place : places) bound = std::min(bound, std::fabs(place.t));
  };
  look_along(direction_of(probe_field(grid, p).gradient));
  look_along(normal);
  if (!(bound > grid.transform.voxel_size / 8)) return bound;

  // Beside an acute edge neither line need meet what is left of it: go down the field, and all about.
  Vec3d q = p;
  for (int step = 0; step < 8; ++step) {
    const FieldProbe at = probe_field(grid, q);
    const double square = at.gradient.dot(at.gradient);
    if (!(square > 0)) break;
    q -= at.gradient * (at.value / square);
  }
  look_along(direction_of(q - p));
  for (int k = 14; k < 27; ++k) look_along(Vec3d(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1).normalized());
  return bound;
}

} // namespace levelray
