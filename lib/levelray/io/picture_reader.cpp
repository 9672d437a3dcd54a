#include "levelray/io/picture_reader.hpp"

#include "levelray/core/error.hpp"
#include "levelray/io/exr_reader.hpp"
#include "levelray/io/input_file.hpp"
#include "levelray/io/png_writer.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <png.h>
#include <stdexcept>

namespace levelray {

namespace {

// The inverse of srgb_byte's curve (IEC 61966-2-1:1999).
double linear_of(double srgb) {
  return srgb <= 0.04045 ? srgb / 12.92 : std::pow((srgb + 0.055) / 1.055, 2.4);
}

void check_size(std::int64_t width, std::int64_t height) {
  if (!(width >= 1 && width <= 65536 && height >= 1 && height <= 65536))
    throw std::runtime_error("has no size that levelray writes");
}

DisplayPicture from_exr(const std::string& path, const Vec3d& linear_background) {
  const Picture file = read_exr(path).picture;
  check_size(width_of(file.data_window), height_of(file.data_window));
  const Picture::Channel* rgba[4] = {};
  for (const Picture::Channel& channel : file.channels)
    for (int c = 0; c < 4; ++c)
      if (channel.name == std::string(1, "RGBA"[c])) rgba[c] = &channel;
  for (const Picture::Channel* channel : rgba)
    if (!channel) throw std::runtime_error("lacks one of the channels R, G, B, A");
  DisplayPicture picture{
      static_cast<int>(width_of(file.data_window)), static_cast<int>(height_of(file.data_window)), {}};
  picture.rgb.resize(3 * file.pixel_count());
  for (std::size_t i = 0; i < file.pixel_count(); ++i)
    for (int c = 0; c < 3; ++c)
      picture.rgb[3 * i + static_cast<std::size_t>(c)] =
          srgb_byte(static_cast<float>(rgba[c]->value(i) + (1 - rgba[3]->value(i)) * linear_background[c]));
  return picture;
}

DisplayPicture read_png(const uninitialized_vector<char>& bytes, const Vec3d& linear_background) {
  png_image png = {};
  png.version = PNG_IMAGE_VERSION;
  if (!png_image_begin_read_from_memory(&png, bytes.data(), bytes.size()))
    throw std::runtime_error(png.message);
  png.format = PNG_FORMAT_RGBA;
  DisplayPicture picture{static_cast<int>(png.width), static_cast<int>(png.height), {}};
  check_size(png.width, png.height);
  std::vector<std::uint8_t> rgba(PNG_IMAGE_SIZE(png));
  const bool read = png_image_finish_read(&png, nullptr, rgba.data(), 0, nullptr) != 0;
  png_image_free(&png);
  if (!read) throw std::runtime_error(png.message);

  double linear[256];
  for (int i = 0; i < 256; ++i) linear[i] = linear_of(i / 255.0);
  picture.rgb.resize(rgba.size() / 4 * 3);
  for (std::size_t i = 0; i < rgba.size() / 4; ++i)
    for (std::size_t c = 0; c < 3; ++c) {
      const double alpha = rgba[4 * i + 3] / 255.0;
      picture.rgb[3 * i + c] = srgb_byte(static_cast<float>(
          linear[rgba[4 * i + c]] * alpha + (1 - alpha) * linear_background[static_cast<int>(c)]));
    }
  return picture;
}

} // namespace

DisplayPicture read_picture(const std::string& path, const Vec3d& background) {
  const Vec3d linear(linear_of(background.x), linear_of(background.y), linear_of(background.z));
  try {
    std::string extension = path.substr(std::min(path.rfind('.'), path.size()));
    for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return extension == ".png" ? read_png(read_input(path, std::uint64_t{1} << 40), linear)
                               : from_exr(path, linear);
  } catch (const Error&) {
    throw; // names the path
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    throw Error(ErrorKind::bad_input, printable(path, 300) + ": " + printable(error.what(), 150));
  }
}

} // namespace levelray
