// Frames as people name them: "1-100", "1001-1100x2", "1,5,-10--1".
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace levelray {

// More than any shot has; a list of all of them takes 4 MB.
inline constexpr std::size_t max_frames = 1'000'000;

// The frames of a comma-separated list, in its order, each once. An item is a number or a range first-last,
// with a step as first-lastxS or first-last@S; numbers have up to nine digits and may be negative. Throws
// Error(usage) that names `option`: for what is no such list, a range whose end is before its begin, a step
// of 0, and more than max_frames frames.
std::vector<int> parse_frames(const std::string& option, const std::string& text);

// The shortest such list of sorted, different frames, cut after about `max_bytes` with "... (N frames)":
// "1-4, 7, 10-20x2".
std::string frames_text(const std::vector<int>& frames, std::size_t max_bytes = 200);

} // namespace levelray
