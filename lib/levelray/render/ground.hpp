// An optional ground plane for the object to stand on.
#pragma once

#include "levelray/core/ray.hpp"
#include "levelray/render/scene.hpp"

#include <optional>
#include <span>

namespace levelray {

// The plane dot(p, up) = height, seen from above only, fading out around the object so that pictures keep a
// transparent background.
struct Ground {
  Vec3d up{0, 1, 0}; // unit
  double height = 0; // world units
  Vec3d centre{0, 0, 0};
  double radius = 1; // of the object, world units: opaque within 2 radii of the centre, gone at 6

  // The ray's crossing with the plane, if it comes from above and has coverage there.
  std::optional<double> hit(const WorldRay& ray) const;
  // In [0,1], of a point of the plane.
  double coverage(const Vec3d& point) const;
};

// The ground of a scene: where its settings leave something open, below the objects' lowest point, around the
// middle of their bounds.
Ground place_ground(const GroundSettings& settings, std::span<const Instance> instances);

// The ground below the surface's lowest point.
Ground ground_below(const BlockGrid& grid, const Vec3d& up);

} // namespace levelray
