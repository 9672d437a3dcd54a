// Central differences of the interpolated value between six points, half a voxel from the hit along each
// axis.
//
// Source: Jamriska 2010, section 5 and Table 2, which gives neither the offset nor the kind of difference but
// counts 16 samples and 3 interpolations: one-sided differences, with the value at the hit known to be 0.
// Ours takes six interpolations around the hit: with +-1/2 the two points of an axis lie a whole voxel apart,
// so that the difference of two trilinear interpolants is continuous and the normal varies smoothly, with
// about half the error of interpolated central differences; +-1/4 is eight times worse, and one-sided
// differences are only of first order. The points stay within the 32 samples of that scheme.
#pragma once

#include "levelray/normal/cell_position.hpp"
#include "levelray/normal/neighbourhood.hpp"

#include <string_view>

namespace levelray {

struct DifferenceOfInterpolations {
  static constexpr std::string_view name = "difference-of-interpolations";
  static constexpr std::string_view source = "Jamriska 2010, section 5";
  static constexpr int samples = 32, interpolations = 6;
  static constexpr double offset_voxels = 0.5;

  static Vec3d gradient(const Neighbourhood& f, const CellPosition& at);
};

} // namespace levelray
