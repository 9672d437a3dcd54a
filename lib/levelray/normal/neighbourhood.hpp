// The samples around a cell: its corners and one more on each side.
#pragma once

#include "levelray/grid/block_grid.hpp"

namespace levelray {

// Samples cell-1 .. cell+2 along each axis, counted from the cell's lowest corner. Those that a grid does not
// hold are worth +-background, as everywhere. Normal schemes that are not `whole` (cell_position.hpp) look at
// 32 of them only, those with at most one index that is -1 or 2: whoever fills a neighbourhood for them may
// leave the others as they are.
class Neighbourhood {
 public:
  Neighbourhood() = default; // to be filled
  Neighbourhood(const BlockGrid& grid, const Vec3i& cell) {
    for (int k = -1; k < 3; ++k)
      for (int j = -1; j < 3; ++j)
        for (int i = -1; i < 3; ++i) at(i, j, k) = grid.value(cell.x + i, cell.y + j, cell.z + k);
  }

  // Sample (i,j,k), each -1 .. 2.
  float at(int i, int j, int k) const { return samples_[k + 1][j + 1][i + 1]; }
  float& at(int i, int j, int k) { return samples_[k + 1][j + 1][i + 1]; }

 private:
  float samples_[4][4][4];
};

} // namespace levelray
