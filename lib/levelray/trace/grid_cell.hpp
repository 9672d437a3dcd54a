// The grid's cell at a position of a ray's frame.
#pragma once

#include "levelray/accel/ray_frame.hpp"

namespace levelray {

inline Vec3i grid_cell(const SurfaceBlocks& surface, const RayFrame& ray, const int (&position)[3]) {
  Vec3i cell;
  for (int a = 0; a < 3; ++a) {
    const int low = surface.node_min()[a] * node_dim, size = surface.node_dims()[a] * node_dim;
    cell[a] = low + (ray.octant >> a & 1 ? size - 1 - position[a] : position[a]);
  }
  return cell;
}

} // namespace levelray
