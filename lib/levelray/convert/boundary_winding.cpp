#include "levelray/convert/boundary_winding.hpp"

#include "levelray/mesh/winding_number.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <type_traits>

namespace levelray {

namespace {

constexpr double full_angle = 4 * std::numbers::pi;
constexpr std::uint32_t leaf_size = 4;
// Samples are moved by the same rule as in the crossing tests, (e1, e2, e3) with e1 >> e2 >> e3, here by real
// but tiny amounts, so that a sample on a cap counts as on the same side in both terms of the difference.
Vec3d moved(const Vec3d& p) {
  return p + Vec3d(1e-6, 1e-8, 1e-10);
}

} // namespace

BoundaryWinding::BoundaryWinding(const VoxelMesh& mesh) {
  const auto& v = mesh.vertices;
  for (std::size_t t = mesh.surface_count; t < mesh.triangles.size(); ++t) {
    const Triangle& cap = mesh.triangles[t];
    caps_.push_back({{v[cap[0]], v[cap[1]], v[cap[2]]}});
  }
  for (const auto& edge : mesh.boundary) edges_.push_back({{v[edge[0]], v[edge[1]]}});
  if (!caps_.empty()) build(caps_, 0, static_cast<std::uint32_t>(caps_.size()), cap_clusters_);
  if (!edges_.empty()) build(edges_, 0, static_cast<std::uint32_t>(edges_.size()), edge_clusters_);
}

template <class Item>
void BoundaryWinding::build(std::vector<Item>& items, std::uint32_t begin, std::uint32_t end,
                            std::vector<Cluster>& clusters) {
  const std::size_t index = clusters.size();
  clusters.emplace_back();
  Cluster cluster;
  cluster.begin = begin;
  cluster.end = end;
  Box3d box;
  for (std::uint32_t i = begin; i < end; ++i) {
    const auto& corner = items[i].corner;
    for (const Vec3d& c : corner) box.extendBy(c);
    if constexpr (std::is_same_v<Item, Cap>) {
      const Vec3d area_vector = (corner[1] - corner[0]).cross(corner[2] - corner[0]) / 2;
      cluster.dipole += area_vector;
      cluster.size += area_vector.length();
    } else {
      cluster.size += (corner[1] - corner[0]).length();
    }
  }
  cluster.center = box.center();
  cluster.radius = box.size().length() / 2;
  cluster.leaf = end - begin <= leaf_size;
  if (!cluster.leaf) {
    // Halve along the box's longest side; the items' own order settles ties, so the tree is the same
    // everywhere.
    const Vec3d size = box.size();
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const auto key = [&](const Item& item) {
      double sum = 0;
      for (const Vec3d& c : item.corner) sum += c[axis];
      return sum;
    };
    std::stable_sort(items.begin() + begin, items.begin() + end,
                     [&](const Item& p, const Item& q) { return key(p) < key(q); });
    const std::uint32_t split = (begin + end) / 2;
    build(items, begin, split, clusters);
    build(items, split, end, clusters);
  }
  cluster.skip = static_cast<std::uint32_t>(clusters.size());
  clusters[index] = cluster;
}

double BoundaryWinding::exact(const Vec3d& p) const {
  const Vec3d at = moved(p);
  double sum = 0;
  for (const Cap& cap : caps_) sum += solid_angle(cap.corner[0], cap.corner[1], cap.corner[2], at);
  return sum / full_angle;
}

BoundaryWinding::Estimate BoundaryWinding::estimate(const Vec3d& p, double accepted) const {
  const Vec3d at = moved(p);
  double sum = 0, error = 0;
  for (std::uint32_t i = 0; i < cap_clusters_.size();) {
    const Cluster& cluster = cap_clusters_[i];
    // The solid angle is the integral of n . f over the caps, f(x) = (x - p) / |x - p|^3, up to orientation;
    // |grad f| <= 2 / |x - p|^3, so replacing x by the centre errs by at most area * radius * 2 / (distance -
    // radius)^3.
    const Vec3d to_center = cluster.center - at;
    const double distance = to_center.length(), nearest = distance - cluster.radius;
    const double bound = 2 * cluster.size * cluster.radius / (nearest * nearest * nearest);
    if (nearest > 0 && bound < accepted * full_angle) {
      sum += cluster.dipole.dot(to_center) / (distance * distance * distance);
      error += bound;
      i = cluster.skip;
      continue;
    }
    if (cluster.leaf)
      for (std::uint32_t c = cluster.begin; c < cluster.end; ++c)
        sum += solid_angle(caps_[c].corner[0], caps_[c].corner[1], caps_[c].corner[2], at);
    ++i;
  }
  return {sum / full_angle, error / full_angle + 1e-9}; // 1e-9: rounding of thousands of terms below 2 pi
}

double BoundaryWinding::variation(const Vec3d& center, double radius) const {
  double sum = 0;
  for (std::uint32_t i = 0; i < edge_clusters_.size();) {
    const Cluster& cluster = edge_clusters_[i];
    const double distance = (cluster.center - center).length() - cluster.radius - radius;
    if (distance > 2 * cluster.radius) {
      sum += cluster.size / (distance * distance);
      i = cluster.skip;
      continue;
    }
    if (cluster.leaf)
      for (std::uint32_t c = cluster.begin; c < cluster.end; ++c) {
        const Vec3d &a = edges_[c].corner[0], along = edges_[c].corner[1] - a;
        const double squared = along.dot(along);
        const double s = squared > 0 ? std::clamp((center - a).dot(along) / squared, 0.0, 1.0) : 0.0;
        const double to_edge = (a + along * s - center).length() - radius;
        if (!(to_edge > 0)) return std::numeric_limits<double>::infinity();
        sum += std::sqrt(squared) / (to_edge * to_edge);
      }
    ++i;
  }
  return radius * sum / full_angle;
}

} // namespace levelray
