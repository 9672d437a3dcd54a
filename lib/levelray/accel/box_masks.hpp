// 64-bit masks of the 4x4x4 children of a node or a block, as a ray sees them.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

namespace levelray {

// The mask with the axes of `octant` mirrored: child (x,y,z) moves to (3-x,y,z) and so on.
[[gnu::always_inline]] inline std::uint64_t mirror_mask(std::uint64_t mask, int octant) {
  if (octant & 1) {
    mask = (mask & 0x5555555555555555ull) << 1 | (mask >> 1 & 0x5555555555555555ull);
    mask = (mask & 0x3333333333333333ull) << 2 | (mask >> 2 & 0x3333333333333333ull);
  }
  if (octant & 2) {
    mask = (mask & 0x0F0F0F0F0F0F0F0Full) << 4 | (mask >> 4 & 0x0F0F0F0F0F0F0F0Full);
    mask = (mask & 0x00FF00FF00FF00FFull) << 8 | (mask >> 8 & 0x00FF00FF00FF00FFull);
  }
  if (octant & 4) {
    mask = (mask & 0x0000FFFF0000FFFFull) << 16 | (mask >> 16 & 0x0000FFFF0000FFFFull);
    mask = mask << 32 | mask >> 32;
  }
  return mask;
}

// Children whose coordinate along an axis lies in low..high, by [axis][low][high].
inline constexpr auto layer_masks = [] {
  std::array<std::array<std::array<std::uint64_t, 4>, 4>, 3> masks{};
  for (int axis = 0; axis < 3; ++axis)
    for (int low = 0; low < 4; ++low)
      for (int high = low; high < 4; ++high)
        for (int bit = 0; bit < 64; ++bit) {
          const int digit = bit >> 2 * axis & 3;
          if (digit >= low && digit <= high) masks[axis][low][high] |= std::uint64_t{1} << bit;
        }
  return masks;
}();

// Bit d set: some bit of the mask has that digit along the axis.
inline unsigned used_layers(std::uint64_t mask, int axis) {
  unsigned result = 0;
  if (axis == 2) {
    for (int d = 0; d < 4; ++d) result |= unsigned{(mask >> 16 * d & 0xFFFF) != 0} << d;
    return result;
  }
  const std::uint64_t pairs = mask | mask >> 32;
  const auto xy = static_cast<unsigned>((pairs | pairs >> 16) & 0xFFFF);
  if (axis == 0) return (xy | xy >> 4 | xy >> 8 | xy >> 12) & 0xF;
  for (int d = 0; d < 4; ++d) result |= unsigned{(xy >> 4 * d & 0xF) != 0} << d;
  return result;
}

// The box of the children that have bits, of which there is one at least: low .. high - 1 per axis.
struct ChildExtent {
  int low[3], high[3];

  explicit ChildExtent(std::uint64_t mask) {
    for (int a = 0; a < 3; ++a) {
      const unsigned used = used_layers(mask, a);
      low[a] = std::countr_zero(used);
      high[a] = std::bit_width(used);
    }
  }
};

} // namespace levelray
