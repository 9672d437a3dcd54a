// Where the surface of a grid is, for framing and for standing it on the ground.
#pragma once

#include "levelray/grid/block_grid.hpp"

namespace levelray {

struct SurfaceExtent {
  Box3d bounds;      // world units; empty when the grid has no surface
  double lowest = 0; // the least dot(point, up), world units
};

// The extent of the points where the surface crosses the edges of its cells, by linear interpolation along
// them (exact for the trilinear interpolant, which is linear on edges). Between edges it may bulge further by
// a fraction of a voxel. `up` need not have unit length.
SurfaceExtent surface_extent(const BlockGrid& grid, const Vec3d& up);

} // namespace levelray
