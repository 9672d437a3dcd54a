#include "levelray/trace/level_set.hpp"

#include "levelray/core/error.hpp"

namespace levelray {

namespace {

const BlockGrid& checked(const BlockGrid& grid) {
  if (grid.cells.size() != grid.block_count())
    throw Error(ErrorKind::failed,
                "the grid has no cell masks; call update_cell_masks after changing samples");
  return grid;
}

} // namespace

LevelSet::LevelSet(const BlockGrid& grid) : grid_(&grid), surface_(checked(grid)) {}

} // namespace levelray
