// Paths with a place for the frame's number: "cache/liquid.####.vdb".
#pragma once

#include <string>
#include <vector>

namespace levelray {

// A path and, in it, at most one of
//   ####     the number padded with zeros to that many digits, after the sign: -0010
//   %04d     as printf does, the sign being one of the four: -010; %d without padding
//   {frame}  without padding
// Numbers that need more digits get them.
class FramePattern {
 public:
  FramePattern() = default;
  // Throws Error(usage) for two places in one path.
  explicit FramePattern(const std::string& path);
  // A path that is taken as it is.
  static FramePattern literal(const std::string& path);

  bool has_frame() const { return style_ != Style::none; }
  const std::string& text() const { return text_; }

  // The frame's path; the path itself when there is no place for a number.
  std::string path(int frame) const;

  // The frames, sorted, for which path(frame) exists now.
  std::vector<int> existing() const;

 private:
  enum class Style { none, hashes, printf, plain };

  std::string number(int frame) const;

  std::string text_, before_, after_;
  Style style_ = Style::none;
  int width_ = 0; // least count of digits, or of characters (printf)
};

} // namespace levelray
