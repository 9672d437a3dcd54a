#include "levelray/io/exr_reader.hpp"

#include "levelray/core/error.hpp"
#include "levelray/io/exr_header.hpp"
#include "levelray/io/input_file.hpp"
#include "levelray/io/limited_process.hpp"

#include <ImfFrameBuffer.h>
#include <ImfIO.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfThreading.h>
#include <array>
#include <cstring>
#include <fmt/format.h>
#include <new>

namespace levelray {

namespace {

constexpr std::uint64_t layout = 0x3172787272766C6C; // changes with what is sent

// OpenEXR's door to a file, leading to memory.
class MemoryInput : public Imf::IStream {
 public:
  explicit MemoryInput(std::string_view bytes) : Imf::IStream("memory"), bytes_(bytes) {}
  bool read(char to[], int n) override {
    if (n < 0 || at_ > bytes_.size() || static_cast<std::size_t>(n) > bytes_.size() - at_)
      throw std::runtime_error("the file ends early or points beyond its end (truncated or damaged)");
    std::memcpy(to, bytes_.data() + at_, static_cast<std::size_t>(n));
    at_ += static_cast<std::size_t>(n);
    return at_ < bytes_.size();
  }
  uint64_t tellg() override { return at_; }
  void seekg(uint64_t position) override { at_ = position; }

 private:
  const std::string_view bytes_;
  uint64_t at_ = 0;
};

void check_readable(const ExrPart& part, const std::string& path) {
  const auto fail = [&](const std::string& reason) {
    throw Error(ErrorKind::bad_input, path + ": " + reason);
  };
  if (part.deep) fail("deep pixels (many samples each) are not supported");
  for (const ExrPart::Channel& channel : part.channels)
    if (channel.x_sampling != 1 || channel.y_sampling != 1)
      fail(fmt::format("channel \"{}\" is stored for every {} x {} pixels only; subsampled channels are not "
                       "supported",
                       printable(channel.name, 60), channel.x_sampling, channel.y_sampling));
}

// Bytes for reading a part beside the file's own: the values, and what OpenEXR takes.
std::uint64_t memory_needed(const ExrPart& part) {
  const auto width = static_cast<std::uint64_t>(width_of(part.data_window)),
             height = static_cast<std::uint64_t>(height_of(part.data_window));
  const std::uint64_t values = width * height * part.channels.size() * sizeof(std::uint32_t);
  // A row of tiles is cached; a chunk of at most 256 scan lines (DWAB) is unpacked in two buffers, and the
  // method keeps some tables of its own.
  const std::uint64_t tile_rows =
      part.tiled ? (width + part.tile_width) * part.tile_height * part.bytes_per_pixel : 0;
  const std::uint64_t chunk = part.tiled
                                  ? std::uint64_t{part.tile_width} * part.tile_height * part.bytes_per_pixel
                                  : width * std::min<std::uint64_t>(height, 256) * part.bytes_per_pixel;
  return values + 2 * tile_rows + 6 * chunk + (std::uint64_t{64} << 20);
}

void read_pixels(std::string_view bytes, Picture& picture) {
  Imf::setGlobalThreadCount(0);
  MemoryInput stream(bytes);
  // An incomplete table of offsets is an incomplete file: nothing is searched for.
  Imf::MultiPartInputFile file(stream, 0, /*reconstructChunkOffsetTable=*/false);
  Imf::InputPart part(file, 0);
  Imf::FrameBuffer frame_buffer;
  const std::size_t row = static_cast<std::size_t>(width_of(picture.data_window)) * sizeof(std::uint32_t);
  for (Picture::Channel& channel : picture.channels)
    frame_buffer.insert(channel.name,
                        Imf::Slice::Make(channel.type == Picture::Type::uint32 ? Imf::UINT : Imf::FLOAT,
                                         channel.words.data(), picture.data_window, sizeof(std::uint32_t),
                                         row));
  part.setFrameBuffer(frame_buffer);
  part.readPixels(picture.data_window.min.y, picture.data_window.max.y);
}

} // namespace

ExrFile read_exr_here(const std::string& path, std::uint64_t max_memory,
                      const std::function<void(std::uint64_t bytes)>& reads) {
  const uninitialized_vector<char> content = read_input(path, max_memory);
  const std::string_view bytes(content.data(), content.size());
  const std::vector<ExrPart> parts = read_exr_headers(bytes, path);
  const ExrPart& part = parts.front();
  check_readable(part, path);
  const std::uint64_t needed = memory_needed(part);
  if (needed > max_memory || content.size() > max_memory - needed)
    throw Error(
        ErrorKind::limit,
        fmt::format("{}: {} x {} pixels, {} channels: reading needs up to {} MiB, more than the {} MiB "
                    "allowed; raise --max-memory",
                    path, width_of(part.data_window), height_of(part.data_window), part.channels.size(),
                    needed >> 20, max_memory >> 20));
  if (reads) reads(needed);

  ExrFile file;
  if (parts.size() > 1)
    file.warnings.push_back(fmt::format("{}: has {} parts; the first, \"{}\", is read", path, parts.size(),
                                        printable(part.name, 60)));
  Picture& picture = file.picture;
  picture.data_window = part.data_window;
  picture.display_window = part.display_window;
  for (const ExrPart::Channel& channel : part.channels) {
    picture.channels.push_back({channel.name, channel.type, {}});
    picture.channels.back().words.resize(picture.pixel_count());
  }
  try {
    read_pixels(bytes, picture);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    throw Error(ErrorKind::bad_input, path + ": damaged: " + printable(error.what(), 200));
  }
  return file;
}

void send_exr(const ByteSink& write, const ExrFile& file) {
  StreamOut out(write, layout);
  const std::uint32_t warnings = out.count(file.warnings.size());
  for (std::uint32_t i = 0; i < warnings; ++i) out.text(file.warnings[i]);
  for (const PixelBox& box : {file.picture.display_window, file.picture.data_window})
    out.value(std::array<std::int32_t, 4>{box.min.x, box.min.y, box.max.x, box.max.y});
  const std::uint32_t channels = out.count(file.picture.channels.size());
  for (std::uint32_t i = 0; i < channels; ++i) {
    out.text(file.picture.channels[i].name);
    out.value(file.picture.channels[i].type);
    out.array(file.picture.channels[i].words);
  }
  out.close();
}

ExrFile receive_exr(const ByteSource& read, const std::string& path, std::uint64_t max_bytes) {
  StreamIn in(read, path, layout);
  ExrFile file;
  const std::uint32_t warnings = in.count();
  for (std::uint32_t i = 0; i < warnings; ++i) file.warnings.push_back(in.text());
  Picture& picture = file.picture;
  for (PixelBox* box : {&picture.display_window, &picture.data_window}) {
    const auto corners = in.value<std::array<std::int32_t, 4>>();
    *box = PixelBox({corners[0], corners[1]}, {corners[2], corners[3]});
    in.check(width_of(*box) >= 1 && width_of(*box) <= exr_max_side && height_of(*box) >= 1 &&
                 height_of(*box) <= exr_max_side,
             "a window");
  }
  const std::uint32_t channels = in.count();
  in.check(channels >= 1 && channels <= exr_max_channels, "the number of channels");
  // At most 2^40 pixels and 2^10 channels: no overflow.
  in.check(picture.pixel_count() * channels <= max_bytes / sizeof(std::uint32_t), "a size beyond the limit");
  for (std::uint32_t i = 0; i < channels; ++i) {
    Picture::Channel channel;
    channel.name = in.text();
    in.check(picture.channels.empty() || picture.channels.back().name < channel.name, "a channel's name");
    const auto type = in.value<std::uint8_t>();
    in.check(type <= static_cast<std::uint8_t>(Picture::Type::float32), "a channel's type");
    channel.type = static_cast<Picture::Type>(type);
    in.array(channel.words, picture.pixel_count());
    picture.channels.push_back(std::move(channel));
  }
  in.close();
  return file;
}

ExrFile read_exr(const std::string& path, const ExrReadOptions& options) {
  check_first_bytes(path, "\x76\x2f\x31\x01", "an OpenEXR file");
  if (options.trust_input) return read_exr_here(path, options.max_memory);
  ExrFile file;
  read_in_process({"levelray-exr-reader", "LEVELRAY_EXR_READER", ".exr files"},
                  {path, std::to_string(options.max_memory), fmt::format("{:.3f}", options.timeout_seconds)},
                  path, options.timeout_seconds,
                  [&](const ByteSource& source) { file = receive_exr(source, path, options.max_memory); });
  return file;
}

} // namespace levelray
