// Bit counting without library calls: std::popcount is one in a build for any x86-64.
#pragma once

#include <cstdint>

namespace levelray {

// The number of bits set (Warren, Hacker's Delight, 2nd edition 2013, section 5-1).
constexpr std::uint64_t count_bits(std::uint64_t mask) {
  mask -= mask >> 1 & 0x5555555555555555ull;
  mask = (mask & 0x3333333333333333ull) + (mask >> 2 & 0x3333333333333333ull);
  mask = (mask + (mask >> 4)) & 0x0F0F0F0F0F0F0F0Full;
  return mask * 0x0101010101010101ull >> 56;
}

} // namespace levelray
