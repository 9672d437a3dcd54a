#include "turntable.hpp"

#include "levelray/render/surface_extent.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace levelray {

namespace {

// `v` turned about the unit vector `axis` (Rodrigues' formula).
Vec3d turned(const Vec3d& v, const Vec3d& axis, double turns) {
  const double angle = 2 * std::numbers::pi * (turns - std::floor(turns));
  const double c = std::cos(angle), s = std::sin(angle);
  return v * c + axis.cross(v) * s + axis * (axis.dot(v) * (1 - c));
}

} // namespace

CameraSettings turned_camera(const CameraSettings& camera, double turns) {
  CameraSettings result = camera;
  result.eye = camera.target + turned(camera.eye - camera.target, camera.up.normalized(), turns);
  return result;
}

std::vector<double> turned_surface_support(const BlockGrid& grid, const Vec3d& up, const Vec3d& centre,
                                           std::span<const Vec3d> directions) {
  // To turn the surface one way is to turn the directions the other way.
  constexpr int angles = 64;
  const Vec3d axis = up.normalized();
  std::vector<Vec3d> all;
  for (const Vec3d& d : directions)
    for (int i = 0; i < angles; ++i) all.push_back(turned(d, axis, static_cast<double>(i) / angles));
  const std::vector<double> reach = surface_support(grid, all);

  std::vector<double> largest(directions.size(), -std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < all.size(); ++i)
    largest[i / angles] = std::max(largest[i / angles], reach[i] - centre.dot(all[i]));
  for (std::size_t i = 0; i < directions.size(); ++i) largest[i] += centre.dot(directions[i]);
  return largest;
}

} // namespace levelray
