// Central differences at the cell's corners, interpolated: 32 samples (8 corners and 24 around them; the
// paper counts the 24), continuous across cells. Source: Jamriska 2010, section 5 and Table 2.
#pragma once

#include "levelray/normal/cell_position.hpp"
#include "levelray/normal/neighbourhood.hpp"

#include <string_view>

namespace levelray {

struct InterpolationOfDifferences {
  static constexpr std::string_view name = "interpolation-of-differences";
  static constexpr bool smooth = true;
  static constexpr std::string_view source = "Jamriska 2010, section 5";
  static constexpr int samples = 32, interpolations = 1;
  static constexpr bool whole = false;

  static Vec3d gradient(const Neighbourhood& f, const CellPosition& at);
};

} // namespace levelray
