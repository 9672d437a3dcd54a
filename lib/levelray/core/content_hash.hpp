// An identifier of a file that follows from its bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace levelray {

// A 128-bit hash of bytes, for telling files apart; no protection against forgery. Two 64-bit lanes take in
// each word of eight bytes by xor, multiply and rotate, and are mixed at the end by the finaliser of
// SplitMix64 (Steele, Lea, Flood 2014, figure 17). The result does not depend on how the bytes are cut
// into calls.
class ContentHash {
 public:
  void add(const char* bytes, std::size_t count);

  // The hash as an RFC 9562 version 8 UUID (36 characters): 122 bits of it and the version and variant
  // fields.
  std::string uuid();

 private:
  void add_word(std::uint64_t word);

  std::uint64_t a_ = 0x243F6A8885A308D3, b_ = 0x13198A2E03707344; // digits of pi
  std::uint64_t length_ = 0;
  unsigned char pending_[8] = {};
  std::size_t pending_count_ = 0;
};

} // namespace levelray
