#include "levelray/io/exr_writer.hpp"

#include "levelray/core/error.hpp"
#include "levelray/io/scene_stamp.hpp"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfIntAttribute.h>
#include <ImfOutputFile.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <OpenEXRConfig.h>
#include <algorithm>
#include <cmath>
#include <half.h>
#include <list>
#include <numbers>

namespace levelray {

namespace {

// OpenEXR's door to a file, leading to memory: errors of the disk are then found where files are written.
class MemoryStream : public Imf::OStream {
 public:
  MemoryStream() : Imf::OStream("memory") {}
  void write(const char bytes[], int n) override {
    const std::size_t size = static_cast<std::size_t>(n);
    if (at_ + size > bytes_.size()) bytes_.resize(at_ + size);
    std::copy_n(bytes, size, bytes_.begin() + static_cast<std::ptrdiff_t>(at_));
    at_ += size;
  }
  uint64_t tellp() override { return at_; }
  void seekp(uint64_t position) override { at_ = position; }

  std::string take() { return std::move(bytes_); }

 private:
  std::string bytes_;
  std::size_t at_ = 0;
};

bool is_colour(const std::string& name) {
  return name == "R" || name == "G" || name == "B" || name == "A";
}

half to_half(float value) {
  if (std::isnan(value)) return half(0.0f);
  return half(std::clamp(value, -static_cast<float>(HALF_MAX), static_cast<float>(HALF_MAX)));
}

std::uint32_t to_number(float value) {
  return value > 0 ? static_cast<std::uint32_t>(std::min(value, 0x1p24f)) : 0;
}

Imf::Header make_header(const Image& image, const ExrOptions& options) {
  Imf::Header header(image.width, image.height);
  header.compression() = Imf::ZIP_COMPRESSION;
  if (options.camera) {
    const CameraSettings& camera = options.camera->settings();
    // The window at unit distance along the view axis, whose width spans the image's.
    header.screenWindowWidth() = static_cast<float>(
        2 * std::tan(camera.fov_degrees * std::numbers::pi / 360) * camera.width / camera.height);
    Imf::addWorldToCamera(header, Imath::M44f(options.camera->world_to_camera()));
    Imf::addWorldToNDC(header, Imath::M44f(options.camera->world_to_ndc()));
  }
  if (!options.software.empty()) header.insert("software", Imf::StringAttribute(options.software));
  if (!options.comments.empty()) Imf::addComments(header, options.comments);
  if (options.frame) header.insert("levelray:frame", Imf::IntAttribute(*options.frame));
  if (!options.scene_hash.empty()) {
    header.insert(scene_hash_name, Imf::StringAttribute(options.scene_hash));
    header.insert(content_name, Imf::StringAttribute(std::string(content_length, '0')));
  }
  return header;
}

} // namespace

std::string encode_exr(const Image& image, const ExrOptions& options) {
  try {
    Imf::Header header = make_header(image, options);
    Imf::FrameBuffer frame_buffer;
    std::list<std::vector<half>> halves; // lists: slices point into their elements
    std::list<std::vector<std::uint32_t>> numbers;
    const auto row = static_cast<std::size_t>(image.width);
    for (const Image::Channel& channel : image.channels) {
      if (is_colour(channel.name) && !options.all_float) {
        std::vector<half>& values = halves.emplace_back(channel.values.size());
        std::transform(channel.values.begin(), channel.values.end(), values.begin(), to_half);
        header.channels().insert(channel.name, Imf::Channel(Imf::HALF));
        frame_buffer.insert(channel.name, Imf::Slice(Imf::HALF, reinterpret_cast<char*>(values.data()),
                                                     sizeof(half), row * sizeof(half)));
      } else if (channel.name == "id") {
        std::vector<std::uint32_t>& values = numbers.emplace_back(channel.values.size());
        std::transform(channel.values.begin(), channel.values.end(), values.begin(), to_number);
        header.channels().insert(channel.name, Imf::Channel(Imf::UINT));
        frame_buffer.insert(channel.name, Imf::Slice(Imf::UINT, reinterpret_cast<char*>(values.data()),
                                                     sizeof(std::uint32_t), row * sizeof(std::uint32_t)));
      } else {
        header.channels().insert(channel.name, Imf::Channel(Imf::FLOAT));
        char* values =
            reinterpret_cast<char*>(const_cast<float*>(channel.values.data())); // read, never written
        frame_buffer.insert(channel.name, Imf::Slice(Imf::FLOAT, values, sizeof(float), row * sizeof(float)));
      }
    }
    MemoryStream stream;
    {
      Imf::OutputFile file(stream, header);
      file.setFrameBuffer(frame_buffer);
      file.writePixels(image.height);
    } // the line offset table is written at the end
    std::string bytes = stream.take();
    if (!options.scene_hash.empty()) seal_exr(bytes);
    return bytes;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    throw Error(ErrorKind::failed, std::string("OpenEXR: ") + error.what());
  }
}

const char* openexr_version() {
  return OPENEXR_VERSION_STRING;
}

} // namespace levelray
