#include "levelray/io/png_writer.hpp"

#include "levelray/core/error.hpp"
#include "levelray/io/scene_stamp.hpp"

#include <cmath>
#include <png.h>

namespace levelray {

std::uint8_t srgb_byte(float linear) {
  if (!(linear > 0)) return 0;
  if (linear >= 1) return 255;
  const double x = linear;
  const double encoded = x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
  return static_cast<std::uint8_t>(encoded * 255 + 0.5);
}

std::string encode_png(const Image& image, const std::string& scene_hash) {
  const std::vector<float>* rgba[4] = {image.find("R"), image.find("G"), image.find("B"), image.find("A")};
  for (const auto* channel : rgba)
    if (!channel) throw Error(ErrorKind::failed, "PNG: the image lacks one of the channels R, G, B, A");

  std::vector<std::uint8_t> pixels(image.pixel_count() * 4);
  for (std::size_t i = 0; i < image.pixel_count(); ++i) {
    const float alpha = (*rgba[3])[i];
    if (!(alpha > 0)) continue; // transparent black
    for (int c = 0; c < 3; ++c)
      pixels[4 * i + static_cast<std::size_t>(c)] = srgb_byte((*rgba[c])[i] / alpha);
    pixels[4 * i + 3] = static_cast<std::uint8_t>(std::fmin(alpha, 1.0f) * 255 + 0.5f);
  }

  // libpng's simplified interface: no setjmp, and 8-bit RGBA means sRGB, which it tags with an sRGB chunk.
  png_image png = {};
  png.version = PNG_IMAGE_VERSION;
  png.width = static_cast<png_uint_32>(image.width);
  png.height = static_cast<png_uint_32>(image.height);
  png.format = PNG_FORMAT_RGBA;
  std::string bytes(PNG_IMAGE_PNG_SIZE_MAX(png), '\0');
  png_alloc_size_t size = bytes.size();
  const bool written =
      png_image_write_to_memory(&png, bytes.data(), &size, 0, pixels.data(), 0, nullptr) != 0;
  const std::string reason = png.message;
  png_image_free(&png);
  if (!written) throw Error(ErrorKind::failed, "PNG: " + reason);
  bytes.resize(size);
  if (!scene_hash.empty()) stamp_png(bytes, scene_hash);
  return bytes;
}

} // namespace levelray
