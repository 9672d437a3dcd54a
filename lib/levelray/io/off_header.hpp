// The first word of OFF files.
#pragma once

#include <cstddef>
#include <string_view>

namespace levelray {

struct OffHeader {
  bool found = false;
  std::size_t length = 0; // bytes up to behind the word, with an "appearance {...}" block before it
  bool dimension = false; // 4OFF, nOFF
  int extra_values = 0;   // per vertex after x y z, as the prefixes say: normal 3, colour 4, texture 2
};

// Reads "[ST][C][N][4][n]OFF" at the start of `text`, in any case, also when counts are glued to it.
OffHeader find_off_header(std::string_view text) noexcept;

} // namespace levelray
