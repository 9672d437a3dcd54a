#include "levelray/io/frame_list.hpp"

#include "levelray/core/error.hpp"

#include <cctype>
#include <fmt/format.h>
#include <string_view>
#include <unordered_set>

namespace levelray {

namespace {

// Takes an optional '-' and one to nine digits off the front of `rest`.
bool take_number(std::string_view& rest, int& number) {
  const bool negative = rest.starts_with('-');
  std::size_t end = negative ? 1 : 0;
  const std::size_t first = end;
  int value = 0;
  while (end < rest.size() && std::isdigit(static_cast<unsigned char>(rest[end])) && end - first < 9)
    value = 10 * value + (rest[end++] - '0');
  if (end == first || (end < rest.size() && std::isdigit(static_cast<unsigned char>(rest[end]))))
    return false;
  number = negative ? -value : value;
  rest.remove_prefix(end);
  return true;
}

struct Range {
  int first = 0, last = 0, step = 1;
  bool good = false;
};

Range parse_range(std::string_view text) {
  Range range;
  if (!take_number(text, range.first)) return range;
  range.last = range.first;
  if (text.starts_with('-')) {
    text.remove_prefix(1);
    if (!take_number(text, range.last)) return range;
    if (text.starts_with('x') || text.starts_with('@')) {
      text.remove_prefix(1);
      if (text.starts_with('-') || !take_number(text, range.step)) return range;
    }
  }
  range.good = text.empty();
  return range;
}

} // namespace

std::vector<int> parse_frames(const std::string& option, const std::string& text) {
  const auto refuse = [&](const std::string& item, const std::string& reason) {
    throw Error(ErrorKind::usage,
                fmt::format("{} {}: {}", option, printable(text, 120),
                            item == text ? reason : "\"" + printable(item, 60) + "\" " + reason));
  };
  std::vector<int> frames;
  std::unordered_set<int> seen;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find(',', at), text.size());
    std::string item = text.substr(at, end - at);
    while (!item.empty() && item.front() == ' ') item.erase(0, 1);
    while (!item.empty() && item.back() == ' ') item.pop_back();
    at = end + 1;

    const Range range = parse_range(item);
    if (!range.good) refuse(item, "is no frame or range; write 7, 1-100, 1-100x2 or a list with commas");
    if (range.step < 1) refuse(item, "has a step of 0");
    if (range.last < range.first)
      refuse(item, fmt::format("runs backwards; write {}-{}", range.last, range.first));
    // Both ends have at most nine digits: their difference fits.
    const auto count = static_cast<std::size_t>((range.last - range.first) / range.step) + 1;
    if (frames.size() + count > max_frames) refuse(text, fmt::format("is more than {} frames", max_frames));
    for (std::size_t i = 0; i < count; ++i)
      if (const int frame = range.first + static_cast<int>(i) * range.step; seen.insert(frame).second)
        frames.push_back(frame);
  }
  return frames;
}

std::string frames_text(const std::vector<int>& frames, std::size_t max_bytes) {
  std::string text;
  for (std::size_t i = 0; i < frames.size();) {
    // The longest run of equal steps; two frames are shorter as numbers, unless they follow each other.
    std::size_t end = i + 1;
    const int step = end < frames.size() ? frames[end] - frames[i] : 1;
    while (end < frames.size() && frames[end] - frames[end - 1] == step) ++end;
    if (end - i == 2 && step != 1) end = i + 1;
    std::string item = std::to_string(frames[i]);
    if (end - i > 1) item += fmt::format("-{}", frames[end - 1]);
    if (end - i > 1 && step != 1) item += fmt::format("x{}", step);
    if (text.size() + item.size() > max_bytes) return fmt::format("{}, ... ({} frames)", text, frames.size());
    text += (text.empty() ? "" : ", ") + item;
    i = end;
  }
  return text;
}

} // namespace levelray
