#include "levelray/measure/half_storage.hpp"

#include "levelray/grid/complete_blocks.hpp"

#include <cmath>
#include <half.h>
#include <limits>

namespace levelray {

std::optional<BlockGrid> rounded_to_half(const BlockGrid& grid) {
  constexpr float largest_half = 65504;
  for (const float v : grid.values)
    if (!(std::fabs(v) <= largest_half)) return {};
  BlockGrid rounded = grid;
  for (float& v : rounded.values) v = static_cast<float>(Imath::half(v)) + 0.0f; // + 0: -0 becomes +0
  // Zeros are new surface, whose cells may belong to blocks that were not needed before.
  complete_blocks(rounded, std::numeric_limits<std::uint64_t>::max());
  return rounded;
}

} // namespace levelray
