// Where a vertex lies on its object, and where rays that go on from it begin.
#pragma once

#include "levelray/render/shading.hpp"

#include <cmath>
#include <optional>

namespace levelray {

struct SurfacePlace {
  const SceneObject& object;
  Vec3d at;     // the vertex in the object's space
  Vec3d facing; // world space: unit gradient of the interpolant, towards the path's side

  SurfacePlace(const SceneObject& object, const Vertex& vertex);

  // Where rays that stay on the vertex's side (+1: outside) begin, in world space: at `safe`, the safe point
  // of the last ray, unless that lies far from the surface, because there was none near it, or no longer on
  // its side, because it has been rounded to coordinates far from the world's origin.
  Vec3d start(const Vec3d& safe, double side) const;

  // A point in world space beside the vertex that lies on that side, in the direction of the unit vector n
  // (world space); trace/field_probe.hpp.
  std::optional<Vec3d> beside(const Vec3d& n, double side) const;
};

// Replaces a vertex's safe point where it has been rounded to the other side, far from the world's origin.
inline void check_safe_point(const SceneObject& object, Vertex& vertex) {
  const Vec3d& p = vertex.outside;
  const double limit = object.precise_within;
  if (!(std::fabs(p.x) <= limit && std::fabs(p.y) <= limit && std::fabs(p.z) <= limit))
    vertex.outside = SurfacePlace(object, vertex).start(p, vertex.inner ? -1 : 1);
}

} // namespace levelray
