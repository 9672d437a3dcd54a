#include "levelray/render/ground.hpp"

#include "levelray/render/surface_extent.hpp"

#include <algorithm>

namespace levelray {

std::optional<double> Ground::hit(const WorldRay& ray) const {
  const double descent = -ray.direction.dot(up);
  if (!(descent > 0)) return std::nullopt;
  const double t = (ray.origin.dot(up) - height) / descent;
  if (!(t >= ray.t_min && t <= ray.t_max) || !(coverage(ray.at(t)) > 0)) return std::nullopt;
  return t;
}

double Ground::coverage(const Vec3d& point) const {
  const double distance = (point - centre).length() / radius; // in radii
  const double x = std::clamp((6 - distance) / 4, 0.0, 1.0);
  return x * x * (3 - 2 * x); // a cubic step: no visible edge at either end
}

Ground ground_below(const BlockGrid& grid, const Vec3d& up) {
  Ground ground;
  ground.up = up.normalized();
  const Box3d bounds = surface_bounds(grid);
  if (bounds.isEmpty()) return ground;
  const Vec3d down = -ground.up, middle = bounds.min + bounds.size() * 0.5;
  ground.height = -surface_support(grid, {&down, 1}).front();
  ground.centre = middle - ground.up * (middle.dot(ground.up) - ground.height);
  ground.radius = bounds.size().length() / 2;
  return ground;
}

} // namespace levelray
