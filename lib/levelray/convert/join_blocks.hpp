// Joining the components of two blocks across their common face.
#pragma once

#include "levelray/convert/link_components.hpp"

#include <bit>

namespace levelray {

// Calls unite(component of low, component of high, winding difference high - low) for what lies across the
// common face of `low` and the block `high` at its +axis side; indices count within the sides' components.
template <class Unite>
void join_blocks(const BlockSide& low, const BlockSide& high, int axis, const FaceCrossing& crossing,
                 SheetCounting counting, Unite&& unite) {
  const std::uint64_t high_end = face_samples(axis, 1), low_end = face_samples(axis, 0);
  const int shift =
      3 << (2 * axis); // bits between a sample of the face and the opposite one of its own block

  // A block without a sample near the sheets is one component that is linked to everything beside it.
  if (!low.distance || !high.distance) {
    for (std::size_t a = 0; a < low.components.size(); ++a) {
      const std::uint64_t across = (low.components[a].samples & high_end) >> shift;
      for (std::size_t b = 0; b < high.components.size(); ++b)
        if (across & high.components[b].samples) unite(a, b, 0);
    }
    return;
  }

  // Link masks over the face, in bits of `high`.
  std::uint64_t linked = 0;
  int nth = 0;
  for (std::uint64_t rest = low_end; rest; rest &= rest - 1, ++nth) {
    const int bit = std::countr_zero(rest);
    const bool link =
        low.distance[bit + shift] + high.distance[bit] > link_threshold || (crossing.free >> nth & 1);
    linked |= std::uint64_t{link} << bit;
  }
  for (std::size_t a = 0; a < low.components.size(); ++a) {
    const std::uint64_t across = (low.components[a].samples & high_end) >> shift & linked;
    if (!across) continue;
    for (std::size_t b = 0; b < high.components.size(); ++b)
      if (across & high.components[b].samples) unite(a, b, 0);
  }
  if (linked || counting != SheetCounting::windings || !crossing.tested) return;

  // Nothing is linked: the sheets run along the face. Join across it by what the lowest edge crosses.
  const std::uint64_t sample = low_end & (~low_end + 1);
  for (std::size_t a = 0; a < low.components.size(); ++a)
    for (std::size_t b = 0; b < high.components.size(); ++b)
      if ((low.components[a].samples & sample << shift) && (high.components[b].samples & sample))
        unite(a, b, crossing.winding);
}

} // namespace levelray
