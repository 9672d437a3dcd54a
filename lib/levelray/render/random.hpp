// Random numbers without state: hashes of what they are for, so that pictures depend neither on threads nor
// on tiles.
#pragma once

#include <cstdint>

namespace levelray {

// Mixes a number into a hash. The finaliser of SplitMix64 (Steele, Lea and Flood 2014, "Fast splittable
// pseudorandom number generators", OOPSLA, figure 16), a bijection of the 64 bits.
constexpr std::uint64_t mix_hash(std::uint64_t hash, std::uint64_t value) {
  std::uint64_t z = hash + 0x9E3779B97F4A7C15u * (value + 1);
  z = (z ^ z >> 30) * 0xBF58476D1CE4E5B9u;
  z = (z ^ z >> 27) * 0x94D049BB133111EBu;
  return z ^ z >> 31;
}

// Multiples of 2^-32 in [0,1): the high and the low half of a hash.
constexpr double high_fraction(std::uint64_t hash) {
  return static_cast<double>(hash >> 32) * 0x1p-32;
}
constexpr double low_fraction(std::uint64_t hash) {
  return static_cast<double>(hash & 0xFFFFFFFFu) * 0x1p-32;
}

// The bits of i mirrored behind the binary point: van der Corput's sequence.
constexpr double radical_inverse(std::uint32_t i) {
  double value = 0, digit = 0.5;
  for (; i != 0; i >>= 1, digit *= 0.5)
    if (i & 1) value += digit;
  return value;
}

} // namespace levelray
