#include "levelray/core/content_hash.hpp"

#include <bit>
#include <cstring>
#include <fmt/format.h>

namespace levelray {

namespace {

std::uint64_t finalise(std::uint64_t z) {
  z = (z ^ z >> 30) * 0xBF58476D1CE4E5B9;
  z = (z ^ z >> 27) * 0x94D049BB133111EB;
  return z ^ z >> 31;
}

} // namespace

void ContentHash::add_word(std::uint64_t word) {
  a_ = std::rotl((a_ ^ word) * 0x9E3779B97F4A7C15, 29);
  b_ = std::rotl((b_ + word) * 0xD1342543DE82EF95, 37) ^ a_;
}

void ContentHash::add(const char* bytes, std::size_t count) {
  length_ += count;
  while (count) {
    if (pending_count_ == 0 && count >= 8) {
      std::uint64_t word;
      std::memcpy(&word, bytes, 8);
      add_word(word);
      bytes += 8, count -= 8;
      continue;
    }
    pending_[pending_count_++] = static_cast<unsigned char>(*bytes++);
    --count;
    if (pending_count_ == 8) {
      std::uint64_t word;
      std::memcpy(&word, pending_, 8);
      add_word(word);
      pending_count_ = 0;
    }
  }
}

std::string ContentHash::uuid() {
  std::uint64_t word = 0;
  std::memcpy(&word, pending_, pending_count_);
  add_word(word);
  add_word(length_);
  std::uint64_t high = finalise(a_ + b_), low = finalise(b_ ^ finalise(a_));
  high = (high & ~std::uint64_t{0xF000}) | 0x8000;                  // version 8: made by the application
  low = (low & ~(std::uint64_t{3} << 62)) | std::uint64_t{2} << 62; // variant 10
  return fmt::format("{:08x}-{:04x}-{:04x}-{:04x}-{:012x}", high >> 32, high >> 16 & 0xFFFF, high & 0xFFFF,
                     low >> 48, low & 0xFFFFFFFFFFFF);
}

} // namespace levelray
