// Words and numbers in a text that is in memory as a whole; no locale, no copies.
#pragma once

#include "levelray/io/number_text.hpp"

#include <cstring>
#include <string_view>

namespace levelray {

constexpr bool is_blank(char c) noexcept {
  return c == ' ' || c == '\t' || c == '\v' || c == '\f';
}
constexpr bool is_line_end(char c) noexcept {
  return c == '\n' || c == '\r';
}
constexpr bool is_space(char c) noexcept {
  return is_blank(c) || is_line_end(c);
}

// A position in [at, end). Lines end with LF, CR LF or CR; every function stays inside the text.
struct TextCursor {
  const char* at;
  const char* end;

  bool at_end() const noexcept { return at >= end; }
  bool at_line_end() const noexcept { return at >= end || is_line_end(*at); }

  void skip_blanks() noexcept {
    while (at < end && is_blank(*at)) ++at;
  }
  void skip_space() noexcept {
    while (at < end && is_space(*at)) ++at;
  }
  // To the line's end, not beyond it.
  void skip_rest_of_line() noexcept {
    while (at < end && !is_line_end(*at)) ++at;
  }
  // Past one line end, when the cursor is on one.
  void skip_line_end() noexcept {
    if (at < end && *at == '\r') {
      ++at;
      if (at < end && *at == '\n') ++at;
    } else if (at < end && *at == '\n') {
      ++at;
    }
  }
  // The bytes up to the next space.
  std::string_view word() noexcept {
    const char* from = at;
    while (at < end && !is_space(*at)) ++at;
    return {from, static_cast<std::size_t>(at - from)};
  }
};

// Whether two words are equal when A-Z count as a-z; `lower` is in lower case.
inline bool equal_ignoring_case(std::string_view text, std::string_view lower) noexcept {
  if (text.size() != lower.size()) return false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if ((c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c) != lower[i]) return false;
  }
  return true;
}

} // namespace levelray
