#include "levelray/io/off_header.hpp"

#include "levelray/io/text_cursor.hpp"

#include <algorithm>

namespace levelray {

namespace {

// Behind Geomview's "appearance { ... }" blocks, which may come before the word; 0 when there is none.
std::size_t appearance_length(std::string_view text) noexcept {
  constexpr std::string_view word = "appearance";
  if (text.substr(0, word.size()) != word) return 0;
  std::size_t at = word.size();
  while (at < text.size() && is_space(text[at])) ++at;
  if (at >= text.size() || text[at] != '{') return 0;
  std::size_t depth = 0;
  for (; at < text.size(); ++at) {
    if (text[at] == '{') ++depth;
    if (text[at] == '}' && --depth == 0) {
      for (++at; at < text.size() && is_space(text[at]);) ++at;
      return at;
    }
  }
  return 0;
}

} // namespace

OffHeader find_off_header(std::string_view text) noexcept {
  OffHeader header;
  std::size_t at = appearance_length(text);
  const auto take = [&](std::string_view lower) {
    if (!equal_ignoring_case(text.substr(std::min(at, text.size()), lower.size()), lower)) return false;
    at += lower.size();
    return true;
  };
  const auto take_exactly = [&](char c) {
    if (at >= text.size() || text[at] != c) return false;
    ++at;
    return true;
  };
  if (take("st")) header.extra_values += 2;
  if (take("c")) header.extra_values += 4;
  if (take_exactly('N')) header.extra_values += 3;
  if (take_exactly('4')) header.dimension = true;
  if (take_exactly('n')) header.dimension = true;
  if (!take("off")) return {};
  // "OFFSET" is no header; "OFF8 6 12" is one.
  if (at < text.size() && !is_space(text[at]) && text[at] != '#' && !(text[at] >= '0' && text[at] <= '9'))
    return {};
  header.found = true;
  header.length = at;
  return header;
}

} // namespace levelray
