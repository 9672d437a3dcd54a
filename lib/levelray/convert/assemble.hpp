// The last step of a conversion: distances and sides become a block grid.
#pragma once

#include "levelray/convert/sign.hpp"
#include "levelray/grid/block_grid.hpp"

namespace levelray {

// Stores the blocks with an active sample (closer than the half-width) and those with a cell whose corners
// differ in sign; `sides` has one entry per table entry of the band. Fills everything but the name; frees the
// band's distances as it goes. *inside_samples becomes the number of active samples inside.
BlockGrid assemble_grid(Band& band, const std::vector<NodeSides>& sides, const GridTransform& transform,
                        double half_width_voxels, std::uint64_t* inside_samples);

} // namespace levelray
