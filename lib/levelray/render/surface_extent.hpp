// Where the surface of a grid is, for framing and for standing it on the ground.
#pragma once

#include "levelray/grid/block_grid.hpp"

#include <span>
#include <vector>

namespace levelray {

// For each direction d (of any length), the largest dot(p, d) of the points p, in world units, where the
// surface crosses the edges of its cells; -infinity for a grid without surface. Exact there, because the
// trilinear interpolant is linear on edges; between edges the surface may bulge further by a fraction of a
// voxel.
std::vector<double> surface_support(const BlockGrid& grid, std::span<const Vec3d> directions);

// The box of those points; empty for a grid without surface.
Box3d surface_bounds(const BlockGrid& grid);

} // namespace levelray
