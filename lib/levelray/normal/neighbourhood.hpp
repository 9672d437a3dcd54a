// The 4x4x4 samples around a cell: its corners and one more on each side.
#pragma once

#include "levelray/grid/block_grid.hpp"

namespace levelray {

struct Neighbourhood {
  // Sample (i,j,k), counted from the cell's lowest corner, each -1 .. 2.
  float at(int i, int j, int k) const { return values[(i + 1) + 4 * (j + 1) + 16 * (k + 1)]; }

  float values[64];
};

// Looks up each of the (at most eight) blocks that hold the samples once.
Neighbourhood fetch_neighbourhood(const BlockGrid& grid, const Vec3i& cell);

} // namespace levelray
