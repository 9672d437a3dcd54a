#include "levelray/render/scene_extent.hpp"

#include "levelray/render/surface_extent.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace levelray {

std::vector<double> scene_support(std::span<const Instance> instances, std::span<const Vec3d> directions) {
  std::vector<double> support(directions.size(), -std::numeric_limits<double>::infinity());
  for (const Instance& instance : instances) {
    const Similarity& place = instance.world_from_object;
    if (place.is_identity()) {
      const std::vector<double> own = surface_support(*instance.grid, directions);
      for (std::size_t d = 0; d < own.size(); ++d) support[d] = std::max(support[d], own[d]);
      continue;
    }
    // dot(translation + scale R p, d) = dot(translation, d) + scale dot(p, R^-1 d)
    const Similarity back = place.inverse();
    std::vector<Vec3d> moved;
    for (const Vec3d& d : directions) moved.push_back(back.rotate(d));
    const std::vector<double> own = surface_support(*instance.grid, moved);
    for (std::size_t d = 0; d < own.size(); ++d)
      support[d] = std::max(support[d], place.translation.dot(directions[d]) + place.scale * own[d]);
  }
  return support;
}

Box3d scene_bounds(std::span<const Instance> instances) {
  const Vec3d directions[6] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}};
  const std::vector<double> s = scene_support(instances, directions);
  return std::isfinite(s[0]) ? Box3d(Vec3d(-s[3], -s[4], -s[5]), Vec3d(s[0], s[1], s[2])) : Box3d();
}

} // namespace levelray
