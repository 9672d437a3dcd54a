// A level set by itself: what methods make of it, what is proven about their hits, and how thin it is. For
// grids of which it is not known what they were made from.
#pragma once

#include "levelray/grid/block_grid.hpp"
#include "levelray/measure/error_statistics.hpp"
#include "levelray/measure/thickness.hpp"
#include "levelray/measure/trade.hpp"

#include <cstdint>
#include <functional>
#include <vector>

namespace levelray {

struct GridSuiteSettings {
  std::size_t rays = 8192; // random, through the box of the active samples
  std::uint64_t seed = 1;
  int repetitions = 3; // of timings; 0: none
};

struct GridSuiteResult {
  double megabytes = 0; // of the grid and what tracing adds
  std::uint64_t rays = 0, hits = 0;
  // What `certify` proves about the exact hits and misses. `refuted` and `odd` must be 0: hits that are none,
  // and rays whose crossings do not fit the signs at their ends.
  std::uint64_t crossings = 0, grazes = 0, refuted = 0, odd = 0;
  ErrorStatistics bounds_voxels; // of |t - the true root|, of the crossings
  Thickness thickness;           // of the grid's own surface; one share, that of its voxel size
  std::vector<TradeRow> trade;   // errors of hits: |interpolant| there, which for a distance is that from its
                                 // surface; of normals: degrees from the interpolant's own gradient
};

GridSuiteResult run_grid_suite(
    const BlockGrid& grid, const GridSuiteSettings& settings,
    const std::function<void(double)>& progress = [](double) {});

} // namespace levelray
