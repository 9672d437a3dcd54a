// What the headers of an OpenEXR file announce, read and checked before OpenEXR itself sees the file.
#pragma once

#include "levelray/measure/picture.hpp"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace levelray {

struct ExrPart {
  struct Channel {
    std::string name;
    Picture::Type type = Picture::Type::half;
    int x_sampling = 1, y_sampling = 1;
  };
  std::string name;
  bool deep = false, tiled = false;
  PixelBox data_window, display_window;
  std::vector<Channel> channels;                 // sorted by name
  std::uint64_t bytes_per_pixel = 0;             // uncompressed, in the file's types
  std::uint32_t tile_width = 0, tile_height = 0; // when tiled
  std::uint64_t chunks = 0;                      // at full resolution
};

// The limits that no picture of ours, or of anybody known to us, comes near.
inline constexpr std::int64_t exr_max_side = 1 << 20; // pixels
inline constexpr std::size_t exr_max_channels = 1024; // as OpenImageIO's default
inline constexpr std::size_t exr_max_header_bytes = std::size_t{32}
                                                    << 20; // previews, Cryptomatte's manifests
// A file that unpacks to more than this many times its size is a bomb (OpenImageIO's guard has the same
// number; zlib ends at 1032, black pictures in DWAB reach some thousands).
inline constexpr std::uint64_t exr_max_unpacking = 10000;

// The headers of all parts (at least one), from the bytes of a whole file; layout as in "OpenEXR File Layout"
// (openexr.com). Throws Error(bad_input) "path: reason" unless, for every part: all lengths stay within the
// file, no attribute comes twice, what a reader needs is there and of its type, the data window's sides are
// 1 .. exr_max_side pixels, and the file has room for the chunks and could unpack to the pixels.
std::vector<ExrPart> read_exr_headers(std::string_view bytes, const std::string& path);

} // namespace levelray
