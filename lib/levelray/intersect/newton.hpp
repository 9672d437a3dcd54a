// The interpolant's signs at the two ends decide; Newton-Raphson on the cubic, with a kept bracket, finds the
// place to rounding.
//
// Source: Newton-Raphson for voxels of distance fields as in Hansson-Soderlund, Evans and Akenine-Moller
// 2022, JCGT 11(3), section 2, which splits at the extrema first. Ours does not split, so that the decision
// is that of false position (Jamriska 2010, section 4.2) and what a better place is worth can be told apart
// from what a better decision is (marmitt.hpp): two roots in one cell have equal signs at both ends and are
// lost; of three, one is found, not always the first. The bracket is kept by bisection, so it cannot leave
// the cell or hang where the slope vanishes. The ray's starting side is what signs are compared with, as
// elsewhere.
#pragma once

#include "levelray/intersect/segment_cubic.hpp"

#include <string_view>

namespace levelray {

struct Newton {
  static constexpr std::string_view name = "newton";
  static constexpr std::string_view source =
      "signs at the ends; Newton-Raphson as in Hansson-Soderlund et al. 2022, in a bracket";

  template <class Count = NoCount>
  static bool exists(const CellSegment& segment, double side, Count&& count = {}) {
    count(1);
    if (!(side * interpolate(segment.corner, segment.in) > 0)) return true;
    count(1);
    return side * interpolate(segment.corner, segment.out) <= 0;
  }

  template <class Count = NoCount>
  static bool find(const CellSegment& segment, double side, CellRoot& root, Count&& count = {}) {
    count(2);
    root.outside = CellRoot::nowhere;
    if (!(side * interpolate(segment.corner, segment.in) > 0)) {
      root.at = 0;
      return true;
    }
    if (!(side * interpolate(segment.corner, segment.out) <= 0)) return false;
    count(bernstein_interpolations);
    const SegmentCubic cubic(segment, side); // its ends are those two values
    RootBracket bracket{0, 1, cubic.f.start, cubic.f.end};
    root.at = newton_in_bracket(cubic, bracket);
    if (bracket.f_low > cubic.margin)
      root.outside = bracket.low;
    else if (cubic.f.start > cubic.margin)
      root.outside = 0;
    return true;
  }
};

} // namespace levelray
