// One-sided differences of the interpolated value: at the hit, and half a voxel above it along each axis.
//
// Source: Jamriska 2010, section 5 and Table 2, which gives neither offset nor direction but counts 16
// samples and 3 interpolations, so that the value at the hit must be taken as 0 and the differences be
// one-sided. Ours interpolates the value at the hit too, as the places that approximate intersectors give do
// not have the value 0; 20 samples at the most, 14 on average. Continuous, since interpolants are; but of
// first order only, like any one-sided difference: see offset_differences.hpp for the symmetric one.
#pragma once

#include "levelray/normal/cell_position.hpp"
#include "levelray/normal/neighbourhood.hpp"

#include <string_view>

namespace levelray {

struct DifferenceOfInterpolations {
  static constexpr std::string_view name = "difference-of-interpolations";
  static constexpr bool smooth = true;
  static constexpr std::string_view source = "Jamriska 2010, section 5";
  static constexpr int samples = 20, interpolations = 4;
  static constexpr bool whole = false;
  static constexpr double offset_voxels = 0.5;

  static Vec3d gradient(const Neighbourhood& f, const CellPosition& at);
};

} // namespace levelray
