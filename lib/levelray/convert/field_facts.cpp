#include "levelray/convert/field_facts.hpp"

#include "levelray/core/parallel.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <mutex>
#include <vector>

namespace levelray {

namespace {

// Gradient lengths by their binary logarithm: 64 bins an octave, so that percentiles are right to 0.6 %, from
// 2^-24 to 2^24; the first and last bin hold all beyond.
constexpr int bins_per_octave = 64, octaves = 48, bins = bins_per_octave * octaves;
constexpr double steep = 1.1; // voxels

struct Tally {
  std::vector<std::uint64_t> lengths = std::vector<std::uint64_t>(bins);
  std::uint64_t gradients = 0, beyond = 0, crossings = 0, steep_crossings = 0;
  float largest = 0;

  void add_length(double length) {
    const double place = (std::log2(length) + octaves / 2) * bins_per_octave; // -infinity for 0
    ++lengths[static_cast<std::size_t>(std::clamp(place, 0.0, bins - 1.0))];
    ++gradients;
  }
  void add(const Tally& other) {
    for (std::size_t i = 0; i < bins; ++i) lengths[i] += other.lengths[i];
    gradients += other.gradients, crossings += other.crossings, steep_crossings += other.steep_crossings;
  }
  // The middle of the bin in which the share of all lengths is reached.
  double percentile(double share) const {
    double rank = 0;
    std::size_t i = 0;
    while (i + 1 < bins && (rank += static_cast<double>(lengths[i])) < share * static_cast<double>(gradients))
      ++i;
    return std::exp2((static_cast<double>(i) + 0.5) / bins_per_octave - octaves / 2);
  }
};

// Values that say something: not the background's, which stand for whatever is beyond the band. Foreign grids
// may have a background that is smaller than what is stored, so the limit is that of the values.
void measure_block(const BlockGrid& grid, const Vec3i& corner, std::size_t block, float limit, Tally& tally) {
  const double h = grid.transform.voxel_size;
  const auto in_band = [&](float v) {
    const float size = std::fabs(v);
    return size < limit && size != grid.background;
  };
  for (std::uint64_t rest = grid.active[block]; rest; rest &= rest - 1) {
    const int s = std::countr_zero(rest);
    const float v = grid.values[block * samples_per_block + static_cast<std::size_t>(s)];
    const Vec3i p = corner + Vec3i(bit_x(s), bit_y(s), bit_z(s));
    double square = 0;
    bool crossed = false, measurable = true;
    for (int a = 0; a < 3; ++a) {
      Vec3i step(0, 0, 0);
      step[a] = 1;
      const float up = grid.value(p.x + step.x, p.y + step.y, p.z + step.z);
      const float down = grid.value(p.x - step.x, p.y - step.y, p.z - step.z);
      measurable = measurable && in_band(up) && in_band(down);
      const double slope = (double{up} - double{down}) / (2 * h);
      square += slope * slope;
      crossed = crossed || (in_band(up) && (up < 0) != (v < 0)) || (in_band(down) && (down < 0) != (v < 0));
      if (in_band(v) && in_band(up) && (up < 0) != (v < 0)) { // each pair once, from below
        ++tally.crossings;
        tally.steep_crossings += std::fabs(double{up} - double{v}) > steep * h;
      }
    }
    if (!crossed || !measurable) continue;
    tally.add_length(std::sqrt(square));
  }
}

} // namespace

FieldFacts field_facts(const BlockGrid& grid) {
  // Counts and maxima: the order of adding does not matter.
  Tally all;
  std::mutex mutex;
  parallel_for(grid.block_count(), 4096, [&](std::size_t begin, std::size_t end) {
    std::uint64_t beyond = 0;
    float largest = 0;
    for (std::size_t b = begin; b < end; ++b)
      for (std::uint64_t rest = grid.active[b]; rest; rest &= rest - 1) {
        const float size =
            std::fabs(grid.values[b * samples_per_block + static_cast<std::size_t>(std::countr_zero(rest))]);
        if (size > grid.background) ++beyond, largest = std::max(largest, size);
      }
    const std::lock_guard lock(mutex);
    all.beyond += beyond, all.largest = std::max(all.largest, largest);
  });
  const float limit = std::max(grid.background, all.largest);
  parallel_for(grid.nodes.size(), 256, [&](std::size_t begin, std::size_t end) {
    Tally tally;
    for (std::size_t n = begin; n < end; ++n) {
      const BlockGrid::Node& node = grid.nodes[n];
      std::size_t block = node.first_block;
      for (std::uint64_t rest = node.stored; rest; rest &= rest - 1, ++block) {
        const int bit = std::countr_zero(rest);
        measure_block(grid, node.coord * node_dim + Vec3i(bit_x(bit), bit_y(bit), bit_z(bit)) * block_dim,
                      block, limit, tally);
      }
    }
    const std::lock_guard lock(mutex);
    all.add(tally);
  });

  FieldFacts facts;
  facts.voxel_size = grid.transform.voxel_size;
  facts.crossings = all.crossings;
  if (all.crossings)
    facts.steep_share = static_cast<double>(all.steep_crossings) / static_cast<double>(all.crossings);
  facts.gradients = all.gradients;
  if (all.gradients) {
    facts.gradient_low = all.percentile(0.05);
    facts.gradient_median = all.percentile(0.5);
    facts.gradient_high = all.percentile(0.95);
  }
  facts.beyond = all.beyond;
  facts.largest_beyond = all.largest;
  return facts;
}

std::string describe_field(const FieldFacts& facts) {
  std::string text;
  if (facts.gradients > 0)
    text = fmt::format(
        "gradients near the surface have the median length {:.2f} instead of 1 (5 to 95 %: {:.2f} to "
        "{:.2f}), ",
        facts.gradient_median, facts.gradient_low, facts.gradient_high);
  text += fmt::format(
      "{:.0f} % of the steps across it are steeper than a distance can be: the values are no distances",
      100 * facts.steep_share);
  if (facts.looks_like_voxel_units())
    text += fmt::format(" in world units, but near ones in voxels ({:.2f} a voxel)",
                        facts.gradient_median * facts.voxel_size);
  return text;
}

} // namespace levelray
