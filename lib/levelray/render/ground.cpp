#include "levelray/render/ground.hpp"

#include "levelray/render/scene_extent.hpp"

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

Ground place_ground(const GroundSettings& settings, std::span<const Instance> instances) {
  Ground ground;
  ground.up = settings.up.normalized();
  const Box3d bounds =
      settings.height && settings.centre && settings.radius ? Box3d() : scene_bounds(instances);
  const bool empty = bounds.isEmpty();
  if (settings.height) {
    ground.height = *settings.height;
  } else if (!empty) {
    const Vec3d down = -ground.up;
    ground.height = -scene_support(instances, {&down, 1}).front();
  }
  const Vec3d middle = settings.centre ? *settings.centre
                       : empty         ? Vec3d(0, 0, 0)
                                       : bounds.min + bounds.size() * 0.5;
  ground.centre = middle - ground.up * (middle.dot(ground.up) - ground.height);
  if (settings.radius)
    ground.radius = *settings.radius;
  else if (!empty)
    ground.radius = bounds.size().length() / 2;
  return ground;
}

Ground ground_below(const BlockGrid& grid, const Vec3d& up) {
  GroundSettings settings;
  settings.up = up;
  Instance instance;
  instance.grid = &grid;
  return place_ground(settings, {&instance, 1});
}

} // namespace levelray
