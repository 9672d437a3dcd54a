// The gradient of the tricubic B-spline whose coefficients are the samples: 64 samples, twice continuously
// differentiable.
//
// Source: the uniform cubic B-spline and its derivative (Unser 1999, "Splines: a perfect fit for signal and
// image processing"), for gradients of sampled fields in Sigg and Hadwiger 2005, GPU Gems 2, chapter 20. Ours
// takes the samples as coefficients, without a prefilter: the spline does not interpolate the samples, it
// smooths them, f + h^2/6 of its Laplacian and higher terms. Hits are still those of the trilinear
// interpolant; only the normal comes from here. The error is of second order, smallest of all where the field
// is smooth, and noise of the samples is damped most, but so is every crease.
//
// It reads samples up to 2 voxels beyond the cell, the farthest 2 sqrt(3) = 3.5 voxels from the hit: in a
// narrower band (3 voxels is usual) some of them are worth +-background instead, which for a band of 3 takes
// less than half a voxel from the few values farthest out, whose weights are 1/72 at the most.
#pragma once

#include "levelray/normal/cell_position.hpp"
#include "levelray/normal/neighbourhood.hpp"

#include <string_view>

namespace levelray {

struct TricubicBSpline {
  static constexpr std::string_view name = "tricubic-b-spline";
  static constexpr bool smooth = true;
  static constexpr std::string_view source =
      "cubic B-spline of the samples; Unser 1999, Sigg and Hadwiger 2005";
  static constexpr int samples = 64, interpolations = 1;
  static constexpr bool whole = true;

  static Vec3d gradient(const Neighbourhood& f, const CellPosition& at);
};

} // namespace levelray
