// Sphere tracing of the trilinear interpolant along the segment: steps of |f| over a bound of its slope never
// pass a root.
//
// Source: Hart 1996, "Sphere tracing", whose Lipschitz constant is here a bound for the segment itself, as in
// Galin et al. 2020, "Segment tracing using local Lipschitz bounds". Distances do not do for the step: the
// interpolant of samples that are distances may be as steep as sqrt 3. df/dx is a bilinear interpolation of
// the differences along the cell's four edges in x, hence never larger than the largest of them, so that
//   |df/ds| <= L = sum over axes of (largest edge difference along the axis) * (the segment's extent along
//   it).
// A bound per block (one number for its 64 cells and all directions) would save finding L, at 12 differences
// a cell, for steps that are shorter by the ratio of the bounds, and its steps could pass from cell to cell:
// another walk along the ray, which an intersector, shown one cell's segment, does not have.
//
// From the end the same bound is used backwards: no root lies in the last f(1)/L of the segment. So most
// segments without a root are told by their two ends.
//
// Towards a root steps shrink by a constant factor, towards a grazing one or a near miss ever more slowly,
// and how near is a hit could only be guessed. So nothing is guessed: where a step is below 2^-20 of the
// segment, some 10^-6 voxel, or after 64 of them, what is left of the segment is decided by the split at the
// cubic's extrema (segment_cubic.hpp; Marmitt et al. 2004) and the root behind it, if any, found by Newton's
// method. Running out of steps is neither a hit nor a miss. No root is lost, invented or passed for a later
// one, but for touches within rounding (2^-44 of the largest corner), which may count as either.
#pragma once

#include "levelray/intersect/segment_cubic.hpp"

#include <string_view>

namespace levelray {

struct SphereTracing {
  static constexpr std::string_view name = "sphere-tracing";
  static constexpr std::string_view source =
      "Hart 1996 on the interpolant, a slope bound per segment as in Galin et al. 2020";
  static constexpr int max_steps = 64;

  template <class Count = NoCount>
  static bool exists(const CellSegment& segment, double side, Count&& count = {}) {
    CellRoot root;
    return trace<false>(segment, side, root, count);
  }
  template <class Count = NoCount>
  static bool find(const CellSegment& segment, double side, CellRoot& root, Count&& count = {}) {
    return trace<true>(segment, side, root, count);
  }

  // An upper bound of |df/ds| on the segment, up to rounding.
  static double slope_bound(const CellSegment& segment) {
    double bound = 0;
    for (int a = 0; a < 3; ++a) {
      const int step = 1 << a, b = a == 0 ? 2 : 1, c = a == 2 ? 2 : 4; // the other two axes' bits
      double largest = 0;
      for (const int low : {0, b, c, b + c})
        largest = std::max(largest, std::fabs(double(segment.corner[low + step]) - segment.corner[low]));
      bound += largest * std::fabs(segment.out.x[a] - segment.in.x[a]);
    }
    return bound;
  }

 private:
  // The place is found only if asked for.
  template <bool place, class Count>
  static bool trace(const CellSegment& segment, double side, CellRoot& root, Count& count) {
    root.outside = CellRoot::nowhere;
    root.at = 0;
    count(1);
    double value = side * interpolate(segment.corner, segment.in);
    if (!(value > 0)) return true;
    count(1);
    const double end = side * interpolate(segment.corner, segment.out);
    const bool changes = !(end > 0);
    if (!place && changes) return true; // as every way below would say

    const double margin = safety_margin(segment);
    const double per_value = 1 / slope_bound(segment); // may be infinite: then no root lies before the end
    const double last = changes ? 1 : 1 - end * per_value;
    double s = 0;
    for (int step = 0; step < max_steps; ++step) {
      if (value > margin) root.outside = s;
      const double length = value * per_value;
      if (!(s + length < last)) {
        root.at = 1;
        return changes;
      }
      if (!(length > 0x1p-20)) break;
      s += length;
      count(1);
      value = side * interpolate(segment.corner, point_at(segment, s));
      if (!(value > 0)) { // on a root, but for rounding
        root.at = s;
        return true;
      }
    }

    count(bernstein_interpolations);
    const SegmentCubic cubic(segment, side);
    RootBracket bracket;
    const bool hit = first_bracket(cubic, s, value, bracket);
    root.at = hit ? newton_in_bracket(cubic, bracket) : 1;
    return hit | changes;
  }
};

} // namespace levelray
