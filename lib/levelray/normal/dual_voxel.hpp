// Unit gradients of the eight cells around the nearest sample, each extended to the hit, interpolated by the
// hit's place in the dual voxel, whose corners are the centres of those cells: 27 samples, continuous.
//
// Source: Hansson-Soderlund, Evans and Akenine-Moller 2022, "Ray Tracing of Signed Distance Function Grids",
// JCGT 11(3), section 3.2. Each cell's gradient is that of its own trilinear polynomial at the hit, beyond
// the cell where the hit lies beyond it, and is normalized before interpolation, as theirs. (Evaluated on the
// interpolant itself instead and not normalized, the sum would be that of offset_differences.hpp.) Ours
// differs only at the ends of the data: a cell whose gradient is zero, such as one beyond the band, where
// samples are worth +-background, has no say.
#pragma once

#include "levelray/normal/cell_position.hpp"
#include "levelray/normal/neighbourhood.hpp"

#include <string_view>

namespace levelray {

struct DualVoxel {
  static constexpr std::string_view name = "dual-voxel";
  static constexpr bool smooth = true;
  static constexpr std::string_view source =
      "Hansson-Soderlund, Evans and Akenine-Moller 2022, JCGT 11(3), section 3.2";
  static constexpr int samples = 27, interpolations = 0;
  static constexpr bool whole = true;

  static Vec3d gradient(const Neighbourhood& f, const CellPosition& at);
};

} // namespace levelray
