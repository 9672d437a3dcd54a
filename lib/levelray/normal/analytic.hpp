// The gradient of the trilinear interpolant itself: 8 samples, jumps from cell to cell.
// Source: Jamriska 2010, section 5 and Table 2 ("analytic derivative").
#pragma once

#include "levelray/normal/cell_position.hpp"
#include "levelray/normal/neighbourhood.hpp"

#include <string_view>

namespace levelray {

struct AnalyticNormal {
  static constexpr std::string_view name = "analytic";
  static constexpr bool smooth = false;
  static constexpr std::string_view source = "Jamriska 2010, section 5";
  static constexpr int samples = 8, interpolations = 0;
  static constexpr bool whole = false;

  static Vec3d gradient(const Neighbourhood& f, const CellPosition& at);
};

} // namespace levelray
