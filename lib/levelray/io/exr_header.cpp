#include "levelray/io/exr_header.hpp"

#include "levelray/core/error.hpp"
#include "levelray/io/byte_order.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <map>

namespace levelray {

namespace {

enum Flag : std::uint32_t {
  flag_tiled = 0x200,
  flag_long_names = 0x400,
  flag_deep = 0x800,
  flag_parts = 0x1000
};

struct Attribute {
  std::string type;
  std::string_view data;
};
using Attributes = std::map<std::string, Attribute>;

class HeaderReader {
 public:
  HeaderReader(std::string_view bytes, const std::string& path) : bytes_(bytes), path_(path) {}

  std::vector<ExrPart> parts() {
    if (bytes_.size() < 8 || load<std::uint32_t>(bytes_.data(), false) != 20000630)
      fail("not an OpenEXR file");
    const auto version = load<std::uint32_t>(bytes_.data() + 4, false);
    at_ = 8;
    if ((version & 0xFF) != 2) fail(fmt::format("OpenEXR version {} is unknown; 2 is known", version & 0xFF));
    if (version & ~std::uint32_t{0xFF | flag_tiled | flag_long_names | flag_deep | flag_parts})
      fail("has features of a newer OpenEXR");
    longest_name_ = version & flag_long_names ? 255 : 31;
    std::vector<ExrPart> parts;
    if (!(version & flag_parts)) {
      parts.push_back(part(attributes(), version & flag_tiled, version & flag_deep));
    } else {
      while (next_byte() != 0) {
        const Attributes header = attributes();
        const std::string type(find(header, "type", "string").data);
        parts.push_back(part(header, type == "tiledimage" || type == "deeptile", type.starts_with("deep")));
      }
      ++at_;
      if (parts.empty()) fail("holds no picture");
    }
    std::uint64_t chunks = 0;
    for (const ExrPart& p : parts) chunks += p.chunks;
    // Each chunk has an offset of 8 bytes in a table, and itself begins with 8 bytes at least.
    if (chunks > (bytes_.size() - at_) / 16)
      fail(fmt::format("announces {} chunks of pixels, but the file's {} bytes have no room for them; it is "
                       "truncated or damaged",
                       chunks, bytes_.size()));
    return parts;
  }

 private:
  [[noreturn]] void fail(const std::string& reason) const {
    throw Error(ErrorKind::bad_input, path_ + ": " + reason);
  }
  [[noreturn]] void fail_attribute(const std::string& name, const std::string& reason) const {
    fail(fmt::format("attribute \"{}\" {}", printable(name, 60), reason));
  }

  char next_byte() const {
    if (at_ >= bytes_.size()) fail("the header ends early (truncated or damaged)");
    return bytes_[at_];
  }

  // A text that ends with a zero byte, within the next `longest` bytes.
  std::string text(std::size_t longest) {
    const std::size_t end = bytes_.find('\0', at_);
    if (end == std::string_view::npos) fail("the header ends early (truncated or damaged)");
    if (end - at_ > longest) fail(fmt::format("@{}: a name of more than {} bytes; damaged", at_, longest));
    const std::string found(bytes_.substr(at_, end - at_));
    at_ = end + 1;
    return found;
  }

  Attributes attributes() {
    Attributes found;
    while (next_byte() != 0) {
      const std::size_t begin = at_;
      const std::string name = text(longest_name_), type = text(longest_name_);
      if (bytes_.size() - at_ < 4) fail("the header ends early (truncated or damaged)");
      const auto size = load<std::int32_t>(bytes_.data() + at_, false);
      at_ += 4;
      if (size < 0 || static_cast<std::size_t>(size) > bytes_.size() - at_)
        fail(fmt::format("@{}: attribute \"{}\" announces {} bytes, the file has {} left", begin,
                         printable(name, 60), size, bytes_.size() - at_));
      if (!found.emplace(name, Attribute{type, bytes_.substr(at_, static_cast<std::size_t>(size))}).second)
        fail_attribute(name, "comes twice");
      at_ += static_cast<std::size_t>(size);
      if (at_ > exr_max_header_bytes)
        fail(fmt::format("a header of more than {} MiB", exr_max_header_bytes >> 20));
    }
    ++at_;
    return found;
  }

  const Attribute& find(const Attributes& header, const std::string& name, const std::string& type,
                        std::size_t size = 0) const {
    const auto place = header.find(name);
    if (place == header.end()) fail_attribute(name, "is missing");
    if (place->second.type != type)
      fail_attribute(name,
                     fmt::format("is of type {} instead of {}", printable(place->second.type, 60), type));
    if (size > 0 && place->second.data.size() != size)
      fail_attribute(name, fmt::format("has {} bytes instead of {}", place->second.data.size(), size));
    return place->second;
  }

  PixelBox window(const Attributes& header, const std::string& name) const {
    const char* data = find(header, name, "box2i", 16).data.data();
    const auto number = [&](int i) { return load<std::int32_t>(data + 4 * i, false); };
    PixelBox box;
    box.min = {number(0), number(1)};
    box.max = {number(2), number(3)};
    if (width_of(box) < 1 || height_of(box) < 1 || width_of(box) > exr_max_side ||
        height_of(box) > exr_max_side)
      fail(fmt::format("{} ({}, {}) to ({}, {}): sides must be 1 to {} pixels", name, box.min.x, box.min.y,
                       box.max.x, box.max.y, exr_max_side));
    return box;
  }

  std::vector<ExrPart::Channel> channels(const Attributes& header) const {
    const std::string_view data = find(header, "channels", "chlist").data;
    std::vector<ExrPart::Channel> found;
    std::size_t at = 0;
    const auto damaged = [&] { fail_attribute("channels", "is damaged"); };
    for (;;) {
      const std::size_t end = data.find('\0', at);
      if (end == std::string_view::npos) damaged();
      if (end == at) break; // an empty name ends the list
      ExrPart::Channel channel;
      channel.name = data.substr(at, end - at);
      if (channel.name.size() > longest_name_ || data.size() - end - 1 < 16) damaged();
      if (printable(channel.name, 300) != channel.name)
        fail(fmt::format("channel \"{}\": its name is no text", printable(channel.name, 60)));
      const char* numbers = data.data() + end + 1;
      const auto type = load<std::int32_t>(numbers, false);
      if (type < 0 || type > 2)
        fail(fmt::format("channel \"{}\" is of unknown type {}", printable(channel.name, 60), type));
      channel.type = static_cast<Picture::Type>(type); // 0 uint, 1 half, 2 float: in the same order
      channel.x_sampling = load<std::int32_t>(numbers + 8, false);
      channel.y_sampling = load<std::int32_t>(numbers + 12, false);
      found.push_back(std::move(channel));
      if (found.size() > exr_max_channels) fail(fmt::format("more than {} channels", exr_max_channels));
      at = end + 17;
    }
    if (found.empty()) fail("has no channels");
    std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.name < b.name; });
    for (std::size_t i = 1; i < found.size(); ++i)
      if (found[i].name == found[i - 1].name)
        fail(fmt::format("channel \"{}\" comes twice", printable(found[i].name, 60)));
    return found;
  }

  // Scan lines in a chunk.
  std::uint64_t lines_per_chunk(const Attributes& header) const {
    // none, RLE, ZIPS, ZIP, PIZ, PXR24, B44, B44A, DWAA, DWAB
    constexpr std::uint64_t lines[] = {1, 1, 1, 16, 32, 16, 32, 32, 32, 256};
    const auto method = static_cast<unsigned char>(find(header, "compression", "compression", 1).data[0]);
    if (method >= std::size(lines)) fail(fmt::format("compression {} is unknown", method));
    return lines[method];
  }

  ExrPart part(const Attributes& header, bool tiled, bool deep) const {
    ExrPart part;
    part.tiled = tiled;
    part.deep = deep;
    if (header.contains("name")) part.name = find(header, "name", "string").data;
    part.data_window = window(header, "dataWindow");
    part.display_window = window(header, "displayWindow");
    part.channels = channels(header);
    for (const ExrPart::Channel& channel : part.channels)
      part.bytes_per_pixel += channel.type == Picture::Type::half ? 2 : 4;
    const auto rounded_up = [](std::int64_t n, std::uint64_t d) {
      return (static_cast<std::uint64_t>(n) + d - 1) / d;
    };
    const std::int64_t width = width_of(part.data_window), height = height_of(part.data_window);
    const std::uint64_t lines = lines_per_chunk(header);
    if (tiled) {
      const char* tiles = find(header, "tiles", "tiledesc", 9).data.data();
      part.tile_width = load<std::uint32_t>(tiles, false);
      part.tile_height = load<std::uint32_t>(tiles + 4, false);
      if (part.tile_width < 1 || part.tile_height < 1 || part.tile_width > exr_max_side ||
          part.tile_height > exr_max_side)
        fail(fmt::format("tiles of {} x {} pixels", part.tile_width, part.tile_height));
      part.chunks = rounded_up(width, part.tile_width) * rounded_up(height, part.tile_height);
    } else {
      part.chunks = rounded_up(height, lines);
    }
    // OpenEXR makes its table as long as this says, where it is given.
    if (header.contains("chunkCount"))
      part.chunks = std::max<std::uint64_t>(
          part.chunks, load<std::uint32_t>(find(header, "chunkCount", "int", 4).data.data(), false));
    const std::uint64_t unpacked =
        static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height) * part.bytes_per_pixel;
    if (!deep && unpacked / exr_max_unpacking > bytes_.size())
      fail(fmt::format(
          "{} x {} pixels of {} bytes in a file of {} bytes: more than {} times its size; damaged "
          "or hostile",
          width, height, part.bytes_per_pixel, bytes_.size(), exr_max_unpacking));
    return part;
  }

  const std::string_view bytes_;
  const std::string& path_;
  std::size_t at_ = 0;
  std::size_t longest_name_ = 31;
};

} // namespace

std::vector<ExrPart> read_exr_headers(std::string_view bytes, const std::string& path) {
  return HeaderReader(bytes, path).parts();
}

} // namespace levelray
