// The samples around a cell: its corners and one more on each side.
#pragma once

#include "levelray/grid/block_grid.hpp"

#include <cstdint>

namespace levelray {

// Where a sample of a row of four lies.
struct SampleStep {
  std::uint32_t block;  // bit of the row's axis, set in the second block
  std::uint32_t offset; // in the block
};
struct SampleSteps {
  SampleStep of[3][4][4]; // by axis, place of the first sample in its block, sample
};
inline constexpr SampleSteps sample_steps = [] {
  SampleSteps all{};
  for (unsigned a = 0; a < 3; ++a)
    for (unsigned first = 0; first < 4; ++first)
      for (unsigned i = 0; i < 4; ++i)
        all.of[a][first][i] = {(first + i) >> 2 << a, ((first + i) & 3) << 2 * a};
  return all;
}();

// Reads samples cell-1 .. cell+2 along each axis. They lie in at most two blocks per axis; each of the at
// most eight blocks is looked up once, and then a sample costs one load.
class Neighbourhood {
 public:
  Neighbourhood() = default; // to be assigned
  Neighbourhood(const BlockGrid& grid, const Vec3i& cell);

  // Asks for the cache lines that the samples lie in: 16 floats of one z each.
  void prefetch() const {
    const unsigned crossed = crossed_ & 3;
    unsigned b = 0;
    do {
      for (const SampleStep& z : sample_steps.of[2][first_[2]])
        __builtin_prefetch(blocks_[b | z.block] + z.offset);
      b = (b - crossed) & crossed;
    } while (b);
  }

  // Sample (i,j,k), counted from the cell's lowest corner, each -1 .. 2.
  float at(int i, int j, int k) const {
    const SampleStep &x = sample_steps.of[0][first_[0]][i + 1], &y = sample_steps.of[1][first_[1]][j + 1],
                     &z = sample_steps.of[2][first_[2]][k + 1];
    return blocks_[x.block | y.block | z.block][x.offset + y.offset + z.offset];
  }

 private:
  std::uint32_t first_[3]; // of the lowest samples, in their block
  const float* blocks_[8];
  unsigned crossed_; // axes with samples in two blocks
};

} // namespace levelray
