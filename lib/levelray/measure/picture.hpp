// A picture as a file holds it: exact values of any type, and windows anywhere.
#pragma once

#include "levelray/core/uninitialized_vector.hpp"

#include <ImathBox.h>
#include <bit>
#include <cstdint>
#include <string>
#include <vector>

namespace levelray {

// Pixel coordinates, both corners inclusive; x to the right, y down.
using PixelBox = Imath::Box2i;

inline std::int64_t width_of(const PixelBox& box) {
  return std::int64_t{box.max.x} - box.min.x + 1;
}
inline std::int64_t height_of(const PixelBox& box) {
  return std::int64_t{box.max.y} - box.min.y + 1;
}

struct Picture {
  enum class Type : std::uint8_t { uint32, half, float32 }; // of a channel in the file

  struct Channel {
    std::string name;
    Type type = Type::half;
    // One per pixel of the data window, rows from the top: the bits of a float, or an unsigned integer. A
    // double holds either exactly.
    uninitialized_vector<std::uint32_t> words;

    double value(std::size_t i) const {
      return type == Type::uint32 ? static_cast<double>(words[i])
                                  : static_cast<double>(std::bit_cast<float>(words[i]));
    }
  };

  PixelBox display_window;       // what is to be seen
  PixelBox data_window;          // where there are pixels; may be less or more than the display window
  std::vector<Channel> channels; // sorted by name, which are unique

  std::size_t pixel_count() const {
    return static_cast<std::size_t>(width_of(data_window)) * static_cast<std::size_t>(height_of(data_window));
  }
};

} // namespace levelray
