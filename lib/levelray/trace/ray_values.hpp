// The interpolant along the true ray, enclosed.
#pragma once

#include "levelray/core/ray.hpp"
#include "levelray/grid/block_grid.hpp"

namespace levelray {

// |f - value| <= error; a NaN proves nothing.
struct Enclosure {
  double value = 0, error = 0;

  bool surely_positive() const { return value > error; }
  bool surely_not_positive() const { return value <= -error; } // 0 where it is known to be exactly that
};

// f(o + t d) for the ray's origin, its direction and t taken as the real numbers that these doubles are:
// no rounding of the point, and f within 2^-95 of the sum of its eight terms' sizes. An interpolant that is
// exactly 0 for want of terms (on a face whose four corners are 0) is known to be.
//
// Exact sums of doubles give the point's place in its cell (double_double.hpp), in units in which a voxel has
// 1 to 2 and the largest component of the direction too: powers of two, so that voxels of any size and
// directions of any length are alike. World coordinates are origin + voxel_size * index as reals, too.
class RayValues {
 public:
  RayValues(const BlockGrid& grid, const WorldRay& ray);

  // In world units, as the samples are.
  Enclosure at(double t) const;

 private:
  const BlockGrid* grid_;
  double offset_[3][2]; // the ray's origin and minus the grid's
  double direction_[3], voxel_;
  int t_exponent_;          // t times 2^that is the factor of direction_
  bool underflows_ = false; // scaling may have lost something of coordinates below 2^-900 voxels
};

} // namespace levelray
