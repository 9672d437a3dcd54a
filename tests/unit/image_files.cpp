#include "levelray/io/exr_writer.hpp"
#include "levelray/io/png_writer.hpp"
#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfInputFile.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <cmath>
#include <cstring>
#include <fstream>
#include <half.h>
#include <limits>
#include <png.h>

using namespace levelray;
using levelray::test::TemporaryFolder;

namespace {

// A gradient with values that files must treat with care: above 1, negative, tiny, NaN, beyond half's range.
Image made_image() {
  Image image{37, 21, {}};
  for (const char* name : {"R", "G", "B", "A", "Z", "N.X"}) {
    std::vector<float>& values = image.add(name);
    for (std::size_t i = 0; i < values.size(); ++i)
      values[i] = static_cast<float>(i) / static_cast<float>(values.size());
  }
  image.channels[0].values[100] = 3.5f;
  image.channels[1].values[101] = -1.0f;
  image.channels[2].values[102] = std::numeric_limits<float>::quiet_NaN();
  image.channels[1].values[103] = 1e9f;
  image.channels[4].values[104] = 1e30f;
  return image;
}

std::vector<std::uint8_t> decode_png(const std::string& bytes, int width, int height) {
  png_image png = {};
  png.version = PNG_IMAGE_VERSION;
  REQUIRE(png_image_begin_read_from_memory(&png, bytes.data(), bytes.size()));
  CHECK(png.width == static_cast<png_uint_32>(width));
  CHECK(png.height == static_cast<png_uint_32>(height));
  png.format = PNG_FORMAT_RGBA;
  std::vector<std::uint8_t> pixels(PNG_IMAGE_SIZE(png));
  REQUIRE(png_image_finish_read(&png, nullptr, pixels.data(), 0, nullptr));
  return pixels;
}

} // namespace

TEST_CASE("an EXR file reads back as it was given, colour as half") {
  const Image image = made_image();
  CameraSettings settings;
  settings.width = image.width;
  settings.height = image.height;
  const Camera camera(settings);
  const std::string bytes = encode_exr(image, {&camera, "levelray test", "Z along the view"});
  CHECK(bytes == encode_exr(image, {&camera, "levelray test", "Z along the view"}));

  const TemporaryFolder folder;
  std::ofstream(folder / "image.exr", std::ios::binary) << bytes;
  Imf::InputFile file((folder / "image.exr").c_str());
  REQUIRE(file.header().dataWindow().max == Imath::V2i(image.width - 1, image.height - 1));
  CHECK(file.header().compression() == Imf::ZIP_COMPRESSION);
  CHECK(Imf::worldToCamera(file.header()) == Imath::M44f(camera.world_to_camera()));
  CHECK(Imf::worldToNDC(file.header()) == Imath::M44f(camera.world_to_ndc()));
  CHECK(file.header().typedAttribute<Imf::StringAttribute>("software").value() == "levelray test");
  CHECK_FALSE(Imf::hasCapDate(file.header()));

  for (const Image::Channel& channel : image.channels) {
    const bool colour = channel.name.size() == 1 && channel.name != "Z";
    REQUIRE(file.header().channels().findChannel(channel.name));
    CHECK(file.header().channels()[channel.name].type == (colour ? Imf::HALF : Imf::FLOAT));
    std::vector<float> values(image.pixel_count());
    Imf::FrameBuffer frame_buffer; // OpenEXR widens halves itself
    frame_buffer.insert(channel.name,
                        Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(values.data()), sizeof(float),
                                   sizeof(float) * static_cast<std::size_t>(image.width)));
    file.setFrameBuffer(frame_buffer);
    file.readPixels(0, image.height - 1);
    for (std::size_t i = 0; i < values.size(); ++i) {
      float expected = channel.values[i];
      if (colour && std::isnan(expected)) expected = 0;
      if (colour) expected = half(std::min(expected, static_cast<float>(HALF_MAX)));
      REQUIRE(values[i] == expected);
    }
  }
}

TEST_CASE("a PNG file reads back as sRGB of the unpremultiplied colours") {
  const Image image = made_image();
  const std::string bytes = encode_png(image);
  CHECK(bytes == encode_png(image));
  CHECK(bytes.find("sRGB") != std::string::npos);
  CHECK(bytes.find("tIME") == std::string::npos);
  const std::vector<std::uint8_t> pixels = decode_png(bytes, image.width, image.height);
  for (std::size_t i = 0; i < image.pixel_count(); ++i) {
    const float alpha = image.channels[3].values[i];
    REQUIRE(pixels[4 * i + 3] == static_cast<int>(alpha * 255 + 0.5f));
    for (std::size_t c = 0; c < 3; ++c)
      REQUIRE(pixels[4 * i + c] == (alpha > 0 ? srgb_byte(image.channels[c].values[i] / alpha) : 0));
  }
}

TEST_CASE("sRGB encoding clamps, hits the standard's points and inverts by the standard's decoding") {
  CHECK(srgb_byte(-1.0f) == 0);
  CHECK(srgb_byte(std::numeric_limits<float>::quiet_NaN()) == 0);
  CHECK(srgb_byte(0.0f) == 0);
  CHECK(srgb_byte(1.0f) == 255);
  CHECK(srgb_byte(std::numeric_limits<float>::infinity()) == 255);
  CHECK(srgb_byte(0.5f) == 188); // 1.055 * 0.5^(1/2.4) - 0.055 = 0.73536, times 255 = 187.5
  CHECK(srgb_byte(0.18f) == 118);
  for (int code = 0; code < 256; ++code) {
    const double v = code / 255.0;
    const double linear = v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
    CHECK(srgb_byte(static_cast<float>(linear)) == code);
  }
}

TEST_CASE("an image without colour is no PNG") {
  Image image{2, 2, {}};
  image.add("Z");
  CHECK_THROWS(encode_png(image));
}
