// A level set ready for tracing: a block grid and the blocks that its surface crosses, laid out for rays.
#pragma once

#include "levelray/accel/surface_blocks.hpp"
#include "levelray/grid/block_grid.hpp"
#include "levelray/trace/hit_normals.hpp"
#include "levelray/trace/trace.hpp"

namespace levelray {

class LevelSet {
 public:
  // Keeps a reference: the grid must outlive the level set and stay as it is. Builds all acceleration data,
  // in parallel, from the grid's cell masks, which must be up to date (update_cell_masks) and complete: every
  // cell whose corners do not all have the same strict sign has its lowest corner in a stored block.
  explicit LevelSet(const BlockGrid& grid);

  const BlockGrid& grid() const { return *grid_; }
  const SurfaceBlocks& surface() const { return surface_; }
  std::size_t bytes() const { return surface_.bytes(); } // beyond the grid

 private:
  const BlockGrid* grid_;
  SurfaceBlocks surface_;
};

} // namespace levelray
