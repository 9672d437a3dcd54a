// What an intersector answers, and what it is asked.
//
// An intersector is a struct with
//   static constexpr std::string_view name, source;
//   template <class Count = NoCount> static bool exists(const CellSegment&, double side, Count&& = {});
//   template <class Count = NoCount> static bool find(const CellSegment&, double side, CellRoot&, Count&& =
//   {});
// `side` is +1 where the ray began outside (positive values), -1 where it began inside. `find` looks for the
// first point of the segment, ends included, where side * f <= 0, and returns false where it sees none;
// `exists` answers the same without the place. Neither ever fails in another way. Both tell count(n) how many
// values of the interpolant, or of its blossom (bernstein.hpp), they compute.
#pragma once

#include "levelray/grid/cell_segment.hpp"

namespace levelray {

struct NoCount {
  void operator()(int) const {}
};

// What side * f must exceed at a place where other rays may begin: 2^-36 of the block's largest sample. They
// compute their point anew, from world coordinates, with an error of some 2^-53 of the grid's size in voxels,
// which moves f by as much of that sample: this serves grids of 2^14 voxels and more. Neither the cell's
// corners nor the coefficients would do, which can all be tiny where f changes fast just beyond the cell.
inline double safety_margin(const CellSegment& segment) {
  return 0x1p-16 * static_cast<double>(segment.error); // which is 2^-20 of that sample
}

struct CellRoot {
  static constexpr double nowhere = -1;

  double at = 0; // fraction of the segment, [0,1]
  double outside =
      nowhere; // a fraction <= at where side * f exceeds safety_margin, or `nowhere` in this segment
};

} // namespace levelray
