// Central differences of the interpolant over exactly one voxel: f(p + e/2) - f(p - e/2) along each axis e.
//
// Source: the difference of interpolations of Jamriska 2010, section 5, with six points around the hit in
// place of the paper's three. Ours: the offset is half a voxel, neither more nor less. The two points of an
// axis are then always on either side of a plane through the cell's middle and a whole voxel apart, so that
// the difference of two piecewise linear functions is itself continuous, with the error of a central
// difference; with +-1/4 both points may lie in one cell, the scheme falls back to the slope of that cell,
// and its error is eight times larger. It reads the 32 samples of interpolated differences and has about half
// their error.
//
// Along its axis a component is a sum of four samples: with x the place in the cell, f(x + 1/2) - f(x - 1/2)
// is (1/2 - x)(r0 - r-1) + (1/2 + x)(r1 - r0) in the lower half of the cell, and its mirror image in the
// upper one. Across, it is interpolated between four such rows. Samples that the grid does not hold are worth
// +-background: within half a voxel of the end of a band the normal leans.
#pragma once

#include "levelray/normal/cell_position.hpp"
#include "levelray/normal/neighbourhood.hpp"

#include <string_view>

namespace levelray {

struct OffsetDifferences {
  static constexpr std::string_view name = "offset-differences";
  static constexpr bool smooth = true;
  static constexpr std::string_view source = "after Jamriska 2010, section 5: six points, half a voxel away";
  static constexpr int samples = 32, interpolations = 6;
  static constexpr bool whole = false;

  static Vec3d gradient(const Neighbourhood& f, const CellPosition& at);
};

} // namespace levelray
