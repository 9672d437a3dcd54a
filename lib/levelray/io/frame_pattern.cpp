#include "levelray/io/frame_pattern.hpp"

#include "levelray/core/error.hpp"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fmt/format.h>
#include <optional>

namespace levelray {

namespace {

namespace fs = std::filesystem;

// The length of "%d" or "%04d" at `at`, and its width; 0 when there is none.
std::size_t printf_length(const std::string& text, std::size_t at, int& width) {
  std::size_t end = at + 1;
  width = 0;
  if (end < text.size() && text[end] == '0') {
    while (end < text.size() && text[end] >= '0' && text[end] <= '9' && width < 100)
      width = 10 * width + (text[end++] - '0');
  }
  return end < text.size() && text[end] == 'd' ? end + 1 - at : 0;
}

} // namespace

FramePattern::FramePattern(const std::string& path) : text_(path) {
  for (std::size_t at = 0; at < path.size();) {
    Style style = Style::none;
    std::size_t length = 0;
    int width = 0;
    if (path[at] == '#') {
      style = Style::hashes;
      length = std::min(path.find_first_not_of('#', at), path.size()) - at;
      width = static_cast<int>(std::min<std::size_t>(length, 100));
    } else if (path[at] == '%' && (length = printf_length(path, at, width)) > 0) {
      style = Style::printf;
    } else if (path.compare(at, 7, "{frame}") == 0) {
      style = Style::plain;
      length = 7;
    }
    if (style == Style::none) {
      ++at;
      continue;
    }
    if (has_frame())
      throw Error(ErrorKind::usage, printable(path, 300) + ": two places for the frame's number; keep one");
    style_ = style;
    width_ = width;
    before_ = path.substr(0, at);
    after_ = path.substr(at += length);
  }
}

FramePattern FramePattern::literal(const std::string& path) {
  FramePattern pattern;
  pattern.text_ = path;
  return pattern;
}

std::string FramePattern::number(int frame) const {
  if (style_ == Style::printf) return fmt::format("{:0{}}", frame, width_);
  const std::string digits = fmt::format("{:0{}}", std::abs(static_cast<long>(frame)), width_);
  return frame < 0 ? "-" + digits : digits;
}

std::string FramePattern::path(int frame) const {
  return has_frame() ? before_ + number(frame) + after_ : text_;
}

std::vector<int> FramePattern::existing() const {
  std::vector<int> frames;
  if (!has_frame()) return frames;
  // The number may be in a folder's name: what follows the next '/' is then looked up for each match.
  const std::size_t slash = before_.rfind('/') + 1; // 0 when there is none
  const std::string folder = slash > 0 ? before_.substr(0, slash) : ".";
  const std::string prefix = before_.substr(slash), suffix = after_.substr(0, after_.find('/'));
  const bool in_folder_name = suffix.size() < after_.size();

  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (name.size() <= prefix.size() + suffix.size() || !name.starts_with(prefix) || !name.ends_with(suffix))
      continue;
    const char* first = name.data() + prefix.size();
    const char* last = name.data() + name.size() - suffix.size();
    int frame = 0;
    const auto [stop, failure] = std::from_chars(first, last, frame);
    if (failure != std::errc() || stop != last || number(frame) != std::string_view(first, last)) continue;
    std::error_code ignored;
    if (!in_folder_name || fs::exists(path(frame), ignored)) frames.push_back(frame);
  }
  std::sort(frames.begin(), frames.end());
  return frames;
}

} // namespace levelray
