// The blocks that tracing relies on.
#pragma once

#include "levelray/grid/block_grid.hpp"

#include <cstdint>

namespace levelray {

// Stores, filled with +-background and without active samples, every block that is missing although one of
// its cells (unit cubes of 8 samples; a cell belongs to the block of its lowest corner) has corners that are
// not all strictly of one sign. A tracer may then look at stored blocks alone. The lowest-corner block of
// such a cell must lie in the node table: the table needs one sample of margin below whatever is not outside.
// Grids whose band is at least sqrt(3) voxels wide on both sides of the surface need no such blocks, and stay
// as they are.
//
// When blocks are added, nodes and blocks are put into the order of the table. Sets `cells`. Returns the
// number of added blocks; throws Error(limit) when the grid would exceed `max_bytes`.
std::uint64_t complete_blocks(BlockGrid& grid, std::uint64_t max_bytes);

} // namespace levelray
