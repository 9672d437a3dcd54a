// How much two signed distance fields differ, sample by sample.
#pragma once

#include "levelray/grid/block_grid.hpp"
#include "levelray/measure/thresholds.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace levelray {

// Differences are in voxels (of the first grid): |a - b| / voxel size. Compared are the samples that are
// active in either grid, an inactive one counting as +-background, and those inactive in both but inside in
// one and outside in the other.
struct GridComparison {
  std::string mismatch; // why the samples cannot be compared; empty: the rest holds
  ThresholdCount samples{Thresholds()};
  double mean = 0, rms = 0, max = 0; // voxels
  Vec3i max_at{0, 0, 0};             // the first sample with the largest difference, by nodes
  Vec3d max_position{0, 0, 0};       // in world space
  std::uint64_t active_a = 0, active_b = 0, only_in_a = 0, only_in_b = 0; // active samples
  std::uint64_t sign_flips = 0;     // one is < 0, the other is not; among samples active in either
  std::uint64_t inactive_flips = 0; // the same among samples inactive in both
  double background_difference = 0; // voxels
  std::vector<std::string> remarks;

  // Backgrounds that differ by more than --fail are a failure, too: the whole field outside the band differs.
  Verdict verdict = Verdict::pass;
};

// Grids do not match when the place of a sample of either differs by more than max(thresholds.fail, 1e-6)
// voxels: moving a sample by d changes a distance by d at most, so smaller ones are no difference beyond the
// threshold. The names are not compared.
GridComparison compare_grids(const BlockGrid& a, const BlockGrid& b, const Thresholds& thresholds = {});

} // namespace levelray
