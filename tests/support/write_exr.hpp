// OpenEXR files of any kind, written for tests by OpenEXR itself.
#pragma once

#include "levelray/measure/picture.hpp"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfTiledOutputFile.h>
#include <cstring>
#include <half.h>
#include <string>
#include <vector>

namespace levelray::test {

struct ExrKind {
  Imf::Compression compression = Imf::ZIP_COMPRESSION;
  bool tiled = false, mipmaps = false;
};

// A picture of the given windows and channels, all zeros.
inline Picture blank_picture(const PixelBox& data, const PixelBox& display,
                             const std::vector<std::pair<std::string, Picture::Type>>& channels) {
  Picture picture;
  picture.data_window = data;
  picture.display_window = display;
  for (const auto& [name, type] : channels) {
    picture.channels.push_back({name, type, {}});
    picture.channels.back().words.assign(picture.pixel_count(), 0);
  }
  return picture;
}

inline Picture blank_picture(int width, int height,
                             const std::vector<std::pair<std::string, Picture::Type>>& channels) {
  const PixelBox box({0, 0}, {width - 1, height - 1});
  return blank_picture(box, box, channels);
}

inline void set(Picture::Channel& channel, std::size_t i, float value) {
  channel.words[i] = std::bit_cast<std::uint32_t>(value);
}

inline Imf::Header header_of(const Picture& picture, const ExrKind& kind) {
  Imf::Header header(picture.display_window, picture.data_window);
  header.compression() = kind.compression;
  for (const Picture::Channel& channel : picture.channels)
    header.channels().insert(channel.name, Imf::Channel(static_cast<Imf::PixelType>(channel.type)));
  if (kind.tiled)
    header.setTileDescription(
        Imf::TileDescription(16, 8, kind.mipmaps ? Imf::MIPMAP_LEVELS : Imf::ONE_LEVEL));
  return header;
}

// The channels' values in their own types, and a frame buffer of them.
struct ExrPixels {
  explicit ExrPixels(const Picture& picture) {
    const auto row = static_cast<std::size_t>(width_of(picture.data_window));
    for (const Picture::Channel& channel : picture.channels) {
      const std::size_t size = channel.type == Picture::Type::half ? 2 : 4;
      std::vector<char>& bytes = storage.emplace_back(channel.words.size() * size);
      for (std::size_t i = 0; i < channel.words.size(); ++i) {
        if (size == 4) {
          std::memcpy(&bytes[4 * i], &channel.words[i], 4);
        } else {
          const half value(std::bit_cast<float>(channel.words[i]));
          std::memcpy(&bytes[2 * i], &value, 2);
        }
      }
      frame_buffer.insert(channel.name,
                          Imf::Slice::Make(static_cast<Imf::PixelType>(channel.type), bytes.data(),
                                           picture.data_window, size, size * row));
    }
  }
  std::vector<std::vector<char>> storage;
  Imf::FrameBuffer frame_buffer;
};

inline void write_exr(const std::string& path, const Picture& picture, const ExrKind& kind = {}) {
  const Imf::Header header = header_of(picture, kind);
  ExrPixels pixels(picture);
  if (!kind.tiled) {
    Imf::OutputFile file(path.c_str(), header);
    file.setFrameBuffer(pixels.frame_buffer);
    file.writePixels(static_cast<int>(height_of(picture.data_window)));
    return;
  }
  Imf::TiledOutputFile file(path.c_str(), header);
  file.setFrameBuffer(pixels.frame_buffer);
  for (int level = 0; level < file.numLevels(); ++level) // the small levels repeat the full one's corner
    file.writeTiles(0, file.numXTiles(level) - 1, 0, file.numYTiles(level) - 1, level);
}

// Several parts of scan lines, named "part0", "part1", ...
inline void write_parts(const std::string& path, const std::vector<Picture>& pictures) {
  std::vector<Imf::Header> headers;
  for (const Picture& picture : pictures) {
    headers.push_back(header_of(picture, {}));
    headers.back().setName("part" + std::to_string(headers.size() - 1));
    headers.back().setType(Imf::SCANLINEIMAGE);
  }
  Imf::MultiPartOutputFile file(path.c_str(), headers.data(), static_cast<int>(headers.size()));
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    ExrPixels pixels(pictures[i]);
    Imf::OutputPart part(file, static_cast<int>(i));
    part.setFrameBuffer(pixels.frame_buffer);
    part.writePixels(static_cast<int>(height_of(pictures[i].data_window)));
  }
}

} // namespace levelray::test
