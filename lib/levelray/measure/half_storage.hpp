// What becomes of a grid that is stored with 16-bit floats.
#pragma once

#include "levelray/grid/block_grid.hpp"

#include <optional>

namespace levelray {

// The grid as it is read again from 16-bit floats (IEEE binary16, rounded to nearest even): a value v moves
// by max(|v| 2^-12, 2^-25), so at the surface by 2^-12 voxel about, unless voxels are smaller than 2^-13 and
// reach its denormal numbers. Nothing where a value is beyond 65504, its largest.
std::optional<BlockGrid> rounded_to_half(const BlockGrid& grid);

} // namespace levelray
