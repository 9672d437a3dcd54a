// Numbers as files write them: independent of the locale and correctly rounded.
#pragma once

#include <cstdint>

namespace levelray {

// `end` is the first byte that is no part of the number, or null when there is no number.
struct ParsedDouble {
  double value;
  const char* end;
};
struct ParsedInteger {
  std::int64_t value;
  const char* end;
};

// Reads [+-] digits [.digits] [e[+-]digits], ".5", "5.", and nan, inf, infinity in any case, also as old C
// runtimes wrote them ("1.#INF", "-1.#IND"), at `at`. The value is the double nearest to the decimal number
// (std::from_chars); beyond the largest double it is an infinity, below the smallest a zero.
ParsedDouble parse_double(const char* at, const char* end) noexcept;

// Reads [+-] digits; numbers beyond 64 bits become the largest or smallest.
ParsedInteger parse_integer(const char* at, const char* end) noexcept;

} // namespace levelray
