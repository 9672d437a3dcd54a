// The interpolant's signs at the two ends decide; N steps of false position find the place.
//
// Source: Jamriska 2010, section 4.2. Two roots in one cell have equal signs at both ends and are lost, as in
// the paper (per million hits: 17 on a sphere of radius 20 voxels, 10,642 on a slab of 0.8 voxel). Ours
// differs in comparing with the side on which the ray began, so that a change of sign between two cells is
// not lost to rounding: a segment that begins on the other side is hit at its start.
#pragma once

#include "levelray/intersect/cell_root.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>

namespace levelray {

template <int Steps>
struct FalsePosition {
  static_assert(Steps >= 1 && Steps <= 9);
  static constexpr char text[] = {'f', 'a', 'l', 's', 'e', '-', 'p', 'o',
                                  's', 'i', 't', 'i', 'o', 'n', '-', '0' + Steps};
  static constexpr std::string_view name{text, sizeof text};
  static constexpr std::string_view source = "Jamriska 2010, section 4.2";

  template <class Count = NoCount>
  static bool exists(const CellSegment& segment, double side, Count&& count = {}) {
    count(1);
    if (!(side * interpolate(segment.corner, segment.in) > 0)) return true;
    count(1);
    return !(side * interpolate(segment.corner, segment.out) > 0);
  }

  template <class Count = NoCount>
  static bool find(const CellSegment& segment, double side, CellRoot& root, Count&& count = {}) {
    count(2);
    double f_low = side * interpolate(segment.corner, segment.in);
    double f_high = side * interpolate(segment.corner, segment.out);
    root.outside = CellRoot::nowhere;
    if (!(f_low > 0)) {
      root.at = 0;
      return true;
    }
    if (f_high > 0) return false;

    const double margin = safety_margin(segment); // the later steps come closer to the root than that
    if (f_low > margin) root.outside = 0;

    // f(low) > 0 >= f(high) throughout, so the denominator is positive.
    double low = 0, high = 1;
    for (int step = 1;; ++step) {
      root.at = low + (high - low) * (f_low / (f_low - f_high));
      if (step == Steps) break;
      count(1);
      const double value = side * interpolate(segment.corner, point_at(segment, root.at));
      if (value > 0) {
        low = root.at, f_low = value;
        if (value > margin) root.outside = low;
      } else {
        high = root.at, f_high = value;
      }
    }
    return true;
  }
};

} // namespace levelray
