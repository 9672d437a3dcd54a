// Our own pictures read again, for movies.
#pragma once

#include "levelray/core/vec.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace levelray {

// Display pixels: sRGB, three bytes each, rows from the top.
struct DisplayPicture {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;
};

// Reads a .png or .exr that levelray wrote, and puts it over a background, blended in linear light.
// `background`: sRGB, in [0,1]. Throws Error(bad_input) naming the path; what read_exr throws.
DisplayPicture read_picture(const std::string& path, const Vec3d& background);

} // namespace levelray
