// The scene of the measurements with meshes: a mesh centred on the origin with a longest side of 1, seen from
// direction (0.35, 0.30, 1) through 45 degrees.
#pragma once

#include "levelray/measure/ray_sets.hpp"
#include "levelray/mesh/triangle_mesh.hpp"
#include "levelray/render/camera.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace levelray {

inline TriangleMesh centred_unit_mesh(TriangleMesh mesh) {
  const Box3d box = mesh.bounds();
  const Vec3d centre = (box.min + box.max) * 0.5, size = box.max - box.min;
  const double longest = std::max({size.x, size.y, size.z});
  for (Vec3d& v : mesh.vertices) v = (v - centre) / longest;
  return mesh;
}

// The eye's distance of 1.58 is where the longest side, face on, fills the view; 41 to 43 % of the rays hit
// the Stanford bunny.
inline Camera study_camera(int size) {
  CameraSettings settings;
  settings.width = settings.height = size;
  settings.target = Vec3d(0, 0, 0);
  settings.eye = Vec3d(0.35, 0.30, 1).normalized() * 1.58;
  return Camera(settings);
}

// The rays through its pixels in coherent order (tiled_pixels), unit directions.
inline std::vector<WorldRay> study_rays(int size) {
  return primary_rays(study_camera(size));
}

} // namespace levelray
