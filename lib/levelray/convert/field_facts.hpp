// Whether a sampled field is a distance near its surface: measured, not believed.
#pragma once

#include "levelray/grid/block_grid.hpp"

#include <cstdint>
#include <string>

namespace levelray {

// Of the samples within a voxel of the surface: active ones with a neighbour along an axis that is in the
// band, too, and on the other side. Such a pair of samples is a crossing. In the band is what is not worth
// +-background and is smaller than that, or than the largest value, should values go beyond the background.
struct FieldFacts {
  std::uint64_t crossings = 0;
  // Share of the crossings whose values differ by more than 1.1 voxels: none in a distance, which changes by
  // no more than the way between two points.
  double steep_share = 0;
  // Lengths of the gradient by central differences, in voxels' worth of world units per voxel, so that a
  // distance has 1: where the six neighbours of such a sample are in the band.
  std::uint64_t gradients = 0;
  double gradient_median = 0, gradient_low = 0, gradient_high = 0; // 50th, 5th and 95th percentile
  // Active samples beyond the background, and the largest of their values.
  std::uint64_t beyond = 0;
  float largest_beyond = 0;
  double voxel_size = 0;

  // A distance sampled at voxel h has |gradient| - 1 = O(h curvature) and less only along medial axes, so the
  // median is within a few per cent of 1 wherever the surface is resolved at all; 0.9 … 1.1 leaves room for
  // half floats and level sets after some smoothing, and so do 10 % of steep crossings. Too few samples
  // (below 100 gradients, 10 crossings) decide nothing.
  bool is_distance() const {
    return !(gradients >= 100 && !(gradient_median > 0.9 && gradient_median < 1.1)) &&
           !(crossings >= 10 && steep_share > 0.1);
  }
  // No distance, but gradients whose median is within 15 % of 1 per voxel.
  bool looks_like_voxel_units() const {
    const double per_voxel = gradient_median * voxel_size;
    return !is_distance() && gradients >= 100 && per_voxel > 0.85 && per_voxel < 1.15;
  }
};

FieldFacts field_facts(const BlockGrid& grid);

// "gradients at the surface have the median length 1.49 instead of 1 …": what makes a field no distance, in
// numbers.
std::string describe_field(const FieldFacts& facts);

} // namespace levelray
