#include "levelray/vdb/level_set_check.hpp"

#include "levelray/core/parallel.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>

namespace levelray {

namespace {

constexpr int bins = 256; // gradient lengths 0 … 4 in steps of 1/64; the last bin holds all above

struct Tally {
  std::array<std::uint64_t, bins> lengths{};
  std::uint64_t measured = 0, beyond = 0;
  float largest = 0;
};

// Central differences at active samples within a voxel of the surface whose six neighbours are in the band.
void measure_block(const BlockGrid& grid, const Vec3i& corner, std::size_t block, Tally& tally) {
  const double h = grid.transform.voxel_size;
  for (std::uint64_t rest = grid.active[block]; rest; rest &= rest - 1) {
    const int s = std::countr_zero(rest);
    const float v = grid.values[block * samples_per_block + static_cast<std::size_t>(s)];
    if (std::fabs(v) > grid.background) ++tally.beyond, tally.largest = std::max(tally.largest, std::fabs(v));
    if (!(std::fabs(v) < h)) continue;
    const Vec3i p = corner + Vec3i(bit_x(s), bit_y(s), bit_z(s));
    double square = 0;
    bool in_band = true;
    for (int a = 0; a < 3; ++a) {
      Vec3i step(0, 0, 0);
      step[a] = 1;
      const float up = grid.value(p.x + step.x, p.y + step.y, p.z + step.z);
      const float down = grid.value(p.x - step.x, p.y - step.y, p.z - step.z);
      in_band = in_band && std::fabs(up) < grid.background && std::fabs(down) < grid.background;
      const double slope = (static_cast<double>(up) - static_cast<double>(down)) / (2 * h);
      square += slope * slope;
    }
    if (!in_band) continue;
    ++tally.measured;
    ++tally.lengths[static_cast<std::size_t>(std::min(std::sqrt(square) * 64, bins - 1.0))];
  }
}

} // namespace

std::vector<std::string> level_set_remarks(const BlockGrid& grid) {
  constexpr std::size_t chunk = 64; // nodes
  std::vector<Tally> tallies((grid.nodes.size() + chunk - 1) / chunk);
  parallel_for(grid.nodes.size(), chunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) {
      const BlockGrid::Node& node = grid.nodes[n];
      std::size_t block = node.first_block;
      for (std::uint64_t rest = node.stored; rest; rest &= rest - 1, ++block) {
        const int bit = std::countr_zero(rest);
        measure_block(grid, node.coord * node_dim + Vec3i(bit_x(bit), bit_y(bit), bit_z(bit)) * block_dim,
                      block, tallies[begin / chunk]);
      }
    }
  });
  Tally all;
  for (const Tally& t : tallies) {
    for (std::size_t i = 0; i < bins; ++i) all.lengths[i] += t.lengths[i];
    all.measured += t.measured, all.beyond += t.beyond, all.largest = std::max(all.largest, t.largest);
  }

  std::vector<std::string> remarks;
  // Interpolation reads the samples of cells that meet the surface, up to sqrt(3) voxels away; below 1.5
  // voxels (users of OpenVDB tools know this number) many of them are clamped.
  if (const double width = grid.half_width_voxels(); !(width >= 1.5))
    remarks.push_back(
        fmt::format("the narrow band is only {:.3g} voxels wide on each side; below 1.5 the surface is "
                    "distorted, 3 is usual",
                    width));
  if (all.beyond)
    remarks.push_back(fmt::format("{} samples of the band lie beyond the background {:.6g}, up to {:.6g}",
                                  all.beyond, grid.background, all.largest));
  // A true distance sampled at voxel h has |gradient| - 1 = O(h curvature) and less only along medial axes,
  // so the median is within a few per cent of 1 wherever the surface is resolved at all; 0.9 … 1.1 leaves
  // room for half floats and level sets after some smoothing.
  std::uint64_t rank = 0;
  std::size_t median = 0;
  while (median + 1 < bins && (rank += all.lengths[median]) * 2 < all.measured) ++median;
  const double length = (static_cast<double>(median) + 0.5) / 64;
  if (all.measured >= 100 && !(length > 0.9 && length < 1.1))
    remarks.push_back(
        fmt::format("gradients near the surface have the median length {:.2f} instead of 1: the values are "
                    "no distances; they are traced as they are",
                    length));
  return remarks;
}

} // namespace levelray
