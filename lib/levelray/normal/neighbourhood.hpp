// The samples around a cell: its corners and one more on each side.
#pragma once

#include "levelray/grid/block_grid.hpp"

#include <array>

namespace levelray {

// Reads samples cell-1 .. cell+2 along each axis. They lie in at most two blocks per axis; each of the at
// most eight blocks is looked up once, and then a sample costs one load.
class Neighbourhood {
 public:
  Neighbourhood(const BlockGrid& grid, const Vec3i& cell);

  // Sample (i,j,k), counted from the cell's lowest corner, each -1 .. 2.
  float at(int i, int j, int k) const {
    const Step x = steps_[0][static_cast<std::size_t>(i + 1)], y = steps_[1][static_cast<std::size_t>(j + 1)],
               z = steps_[2][static_cast<std::size_t>(k + 1)];
    return blocks_[x.block | y.block | z.block][x.offset + y.offset + z.offset];
  }

 private:
  struct Step {
    std::uint32_t block;  // bit of the axis, set in the second block
    std::uint32_t offset; // in the block
  };

  std::array<std::array<Step, 4>, 3> steps_;
  const float* blocks_[8];
};

} // namespace levelray
