// The interpolant at a point, and points that are proven to lie on one side of the surface.
#pragma once

#include "levelray/grid/block_grid.hpp"

#include <optional>

namespace levelray {

struct FieldProbe {
  double value = 0;        // of the trilinear interpolant, world units
  Vec3d gradient{0, 0, 0}; // per world unit; where cells meet, that of the cell with the larger index
  double largest = 0;      // |sample| of the cell
};

// At a point in the grid's world.
FieldProbe probe_field(const BlockGrid& grid, const Vec3d& point);

// Whether side * f is positive by more than rounding at a point in the grid's world.
//
// "By more than rounding" is 2^-26 of the cell's largest sample, hence of the order of 2^-26 voxel. A
// coordinate that goes to another space and back is off by a few 2^-53 of itself, so objects may lie 2^24 of
// their voxels from the world's origin.
bool lies_on_side(const BlockGrid& grid, const Vec3d& point, double side);

// The first of the points at + direction * step, step = 2^-20, 2^-16, ..., 2^-4, 2^-2 voxels, that lies on
// that side; nothing where there is none. `direction` has unit length; it should be the normal for side +1
// and the reverse for -1, with `at` on the surface.
//
// Rays that begin there begin on that side, without an epsilon that might not suffice or reach too far: f is
// looked at. They are shifted by 2^-20 voxel where the surface has a normal at all; thinner sheets than twice
// that have no inside.
std::optional<Vec3d> point_on_side(const BlockGrid& grid, const Vec3d& at, const Vec3d& direction,
                                   double side);

} // namespace levelray
