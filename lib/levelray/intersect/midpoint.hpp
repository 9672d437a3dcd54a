// Every surface cell that the ray meets is hit, halfway between the points where it enters and leaves.
// Source: Jamriska 2010, section 4.2. As the paper says: fast, and visibly wrong on contours.
#pragma once

#include "levelray/intersect/cell_root.hpp"

#include <string_view>

namespace levelray {

struct Midpoint {
  static constexpr std::string_view name = "midpoint";
  static constexpr std::string_view source = "Jamriska 2010, section 4.2";

  template <class Count = NoCount>
  static bool exists(const CellSegment&, double, Count&& = {}) {
    return true;
  }
  template <class Count = NoCount>
  static bool find(const CellSegment& segment, double side, CellRoot& root, Count&& count = {}) {
    count(1);
    root.at = 0.5;
    root.outside =
        side * interpolate(segment.corner, segment.in) > safety_margin(segment) ? 0 : CellRoot::nowhere;
    return true;
  }
};

} // namespace levelray
