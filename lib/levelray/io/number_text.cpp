#include "levelray/io/number_text.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

namespace levelray {

namespace {

bool is_digit(char c) noexcept {
  return c >= '0' && c <= '9';
}

// Whether a decimal number that from_chars called out of range is too large (not too small): the power of ten
// of its first digit that is not 0 is positive. Saturates instead of overflowing.
bool is_huge(const char* at, const char* end) noexcept {
  constexpr std::int64_t cap = 1'000'000'000'000;
  std::int64_t power = 0;
  bool point = false, leading = true;
  for (; at < end && (is_digit(*at) || *at == '.'); ++at) {
    if (*at == '.') {
      point = true;
      continue;
    }
    if (*at != '0') leading = false;
    if (!point && !leading) power = std::min(power + 1, cap);
    if (point && leading) power = std::max(power - 1, -cap);
  }
  if (at < end && (*at == 'e' || *at == 'E')) {
    const ParsedInteger exponent = parse_integer(at + 1, end);
    if (exponent.end != nullptr) power += std::clamp(exponent.value, -2 * cap, 2 * cap);
  }
  return power > 0;
}

} // namespace

ParsedDouble parse_double(const char* at, const char* end) noexcept {
  // from_chars takes a minus, not a plus.
  const char* from = at;
  if (from < end && *from == '+') {
    ++from;
    if (from < end && (*from == '-' || *from == '+')) return {0, nullptr};
  }
  const bool negative = from < end && *from == '-';
  double value = 0;
  const auto [stop, code] = std::from_chars(from, end, value, std::chars_format::general);
  if (code == std::errc::invalid_argument) return {0, nullptr};
  if (code == std::errc::result_out_of_range) {
    value = is_huge(from + negative, stop) ? std::numeric_limits<double>::infinity() : 0.0;
    if (negative) value = -value;
  }
  // "1.#INF" and its kin: what follows "#" does not matter, it is no finite number.
  if (stop < end && *stop == '#' && stop[-1] == '.') {
    const char* tail = stop + 1;
    while (tail < end && ((*tail >= 'A' && *tail <= 'Z') || is_digit(*tail))) ++tail;
    return {std::numeric_limits<double>::quiet_NaN(), tail};
  }
  return {value, stop};
}

ParsedInteger parse_integer(const char* at, const char* end) noexcept {
  const bool negative = at < end && *at == '-';
  if (at < end && (*at == '-' || *at == '+')) ++at;
  if (at >= end || !is_digit(*at)) return {0, nullptr};
  constexpr std::uint64_t largest = static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());
  std::uint64_t magnitude = 0;
  for (; at < end && is_digit(*at); ++at) {
    const std::uint64_t digit = static_cast<std::uint64_t>(*at - '0');
    magnitude = magnitude > (largest - digit) / 10 ? largest : magnitude * 10 + digit;
  }
  const std::int64_t value = static_cast<std::int64_t>(magnitude);
  return {negative ? -value : value, at};
}

} // namespace levelray
