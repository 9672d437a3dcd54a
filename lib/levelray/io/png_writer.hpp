// PNG files of rendered images.
#pragma once

#include "levelray/render/image.hpp"

#include <cstdint>
#include <string>

namespace levelray {

// The sRGB code value 0 .. 255 of a scene-linear value (IEC 61966-2-1:1999), rounded to nearest; values
// outside [0,1] are clamped, NaN is 0.
std::uint8_t srgb_byte(float linear);

// The bytes of an 8-bit RGBA PNG file with an sRGB chunk, from channels R, G, B, A: colour is divided by the
// coverage (PNG's alpha is not premultiplied), clamped and sRGB encoded; alpha is linear. The same image
// gives the same bytes. With a `scene_hash` the file is stamped (io/scene_stamp.hpp). Throws Error(failed)
// where libpng refuses, e.g. for images without those channels.
std::string encode_png(const Image& image, const std::string& scene_hash = "");

} // namespace levelray
