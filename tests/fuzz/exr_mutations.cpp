// Damaged OpenEXR files through the limited reader: whatever happens there, the parent gets a sound picture
// or one line. And damaged answers of a reader that was taken over.
#include "levelray/core/error.hpp"
#include "levelray/io/exr_header.hpp"
#include "levelray/io/exr_reader.hpp"
#include "levelray/io/exr_writer.hpp"
#include "support/catch.hpp"
#include "support/read_output.hpp"
#include "support/temporary_folder.hpp"
#include "support/write_exr.hpp"

#include <chrono>
#include <cstring>
#include <fstream>
#include <map>
#include <random>

using namespace levelray;
using namespace levelray::test;
using Type = Picture::Type;

namespace {

using Random = std::mt19937_64;

// Our own writer's file, and small ones of other kinds: tiles, mipmaps, parts, every compression.
std::vector<std::string> seeds(const TemporaryFolder& dir) {
  std::vector<std::string> files;
  Image image;
  image.width = 23;
  image.height = 37;
  Random random(1);
  for (const char* name : {"R", "G", "B", "A", "Z", "N.x"})
    for (float& value : image.add(name)) value = static_cast<float>(random() % 5) / 4;
  files.push_back(encode_exr(image, {}));

  Picture picture = blank_picture({{-2, 3}, {20, 39}}, {{0, 0}, {31, 31}},
                                  {{"Y", Type::half}, {"Z", Type::float32}, {"id", Type::uint32}});
  for (Picture::Channel& channel : picture.channels)
    for (std::size_t i = 0; i < picture.pixel_count(); ++i)
      set(channel, i, static_cast<float>(random() % 100) / 10);
  const auto add = [&](const ExrKind& kind) {
    write_exr(dir / "seed.exr", picture, kind);
    files.push_back(content_of(dir / "seed.exr"));
  };
  for (int method = 0; method < Imf::NUM_COMPRESSION_METHODS; ++method)
    add({static_cast<Imf::Compression>(method), false, false});
  add({Imf::PIZ_COMPRESSION, true, false});
  add({Imf::ZIP_COMPRESSION, true, true});
  write_parts(dir / "seed.exr", {picture, picture});
  files.push_back(content_of(dir / "seed.exr"));
  return files;
}

std::string mutate(std::string bytes, Random& random) {
  const auto below = [&](std::size_t n) { return static_cast<std::size_t>(random() % n); };
  // Half of the changes go to the first 700 bytes, where the headers and offsets are.
  const auto place = [&] {
    return below(random() % 2 ? std::min<std::size_t>(bytes.size(), 700) : bytes.size());
  };
  static const std::uint32_t odd[] = {0,          1,          2,        0x7FFFFFFF, 0x80000000,
                                      0xFFFFFFFF, 0x7F800000, 1u << 20, 1000};
  for (std::size_t changes = 1 + below(3); changes; --changes) {
    const std::size_t at = place();
    switch (random() % 6) {
    case 0:
      bytes[at] = static_cast<char>(bytes[at] ^ (1 << below(8)));
      break;
    case 1:
      bytes[at] = static_cast<char>(random());
      break;
    case 2:
      std::memcpy(&bytes[at], &odd[below(std::size(odd))], std::min<std::size_t>(4, bytes.size() - at));
      break;
    case 3: { // a piece from elsewhere
      const std::size_t from = place(), length = 1 + below(32);
      bytes.replace(at, std::min(length, bytes.size() - at), bytes.substr(from, length));
      break;
    }
    case 4:
      if (random() % 4 == 0) bytes.erase(at, 1 + below(8));
      break;
    default:
      if (random() % 8 == 0) bytes.resize(std::max<std::size_t>(at, 1));
      break;
    }
    if (bytes.size() < 8) break;
  }
  return bytes;
}

} // namespace

TEST_CASE("100000 damaged OpenEXR headers announce what their file can hold, or are refused") {
  const TemporaryFolder dir;
  const std::vector<std::string> files = seeds(dir);
  constexpr std::uint64_t seed = 20263;
  Random random(seed);
  int sound = 0, refused = 0;
  for (int round = 0; round < 100000; ++round) {
    CAPTURE(seed, round);
    const std::string bytes = mutate(files[static_cast<std::size_t>(round) % files.size()], random);
    try {
      for (const ExrPart& part : read_exr_headers(bytes, "x.exr")) {
        const std::int64_t width = width_of(part.data_window), height = height_of(part.data_window);
        REQUIRE((width >= 1 && width <= exr_max_side && height >= 1 && height <= exr_max_side));
        REQUIRE((!part.channels.empty() && part.channels.size() <= exr_max_channels));
        REQUIRE(part.chunks * 16 <= bytes.size());
        REQUIRE((part.deep || static_cast<std::uint64_t>(width * height) * part.bytes_per_pixel <=
                                  (bytes.size() + 1) * exr_max_unpacking));
      }
      ++sound;
    } catch (const Error& error) {
      REQUIRE(error.kind() == ErrorKind::bad_input);
      REQUIRE(std::string(error.what()).rfind("x.exr: ", 0) == 0);
      ++refused;
    }
  }
  CHECK(sound > 1000);
  CHECK(refused > 1000);
}

TEST_CASE("2000 damaged OpenEXR files give a sound picture or one line, and nothing else") {
  const TemporaryFolder dir;
  const std::string path = dir / "a.exr";
  const std::vector<std::string> files = seeds(dir);
  constexpr std::uint64_t seed = 20262;
  Random random(seed);
  ExrReadOptions options;
  options.max_memory = std::uint64_t{256} << 20;
  options.timeout_seconds = 5;

  std::map<std::string, int> outcomes;
  for (int round = 0; round < 2000; ++round) {
    CAPTURE(seed, round);
    std::ofstream(path, std::ios::binary)
        << mutate(files[static_cast<std::size_t>(round) % files.size()], random);
    const auto start = std::chrono::steady_clock::now();
    try {
      const ExrFile file = read_exr(path, options);
      ++outcomes["read"];
      REQUIRE(!file.picture.channels.empty());
      for (const Picture::Channel& channel : file.picture.channels)
        REQUIRE(channel.words.size() == file.picture.pixel_count());
    } catch (const Error& error) {
      const std::string text = error.what();
      CAPTURE(text);
      REQUIRE((error.kind() == ErrorKind::bad_input || error.kind() == ErrorKind::limit));
      REQUIRE(text.size() <= Error::max_length);
      REQUIRE(text.rfind(path, 0) == 0);
      ++outcomes[text.find("crashed") != std::string::npos    ? "crashed"
                 : text.find("nonsense") != std::string::npos ? "nonsense"
                 : error.kind() == ErrorKind::limit           ? "limit"
                                                              : "refused"];
    }
    // The timeout and some seconds for a loaded machine.
    REQUIRE(std::chrono::steady_clock::now() - start < std::chrono::seconds(30));
  }
  std::string summary;
  for (const auto& [outcome, count] : outcomes) summary += " " + outcome + " " + std::to_string(count);
  WARN("outcomes:" << summary);
  CHECK(outcomes["read"] > 100); // or the mutations break everything and test little
  CHECK(outcomes["refused"] > 100);
}

TEST_CASE("20000 damaged answers of the reader of pictures give a sound picture or an error") {
  struct Ended {};
  ExrFile file;
  file.warnings = {"one"};
  file.picture = blank_picture(5, 3, {{"A", Type::half}, {"B", Type::float32}});
  std::string good;
  send_exr([&](const void* bytes, std::size_t n) { good.append(static_cast<const char*>(bytes), n); }, file);
  constexpr std::uint64_t seed = 6, max_bytes = 1 << 20;
  Random random(seed);
  static const std::uint32_t odd[] = {0, 1, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFF, 1u << 20, 1024};
  int sound = 0, refused = 0;
  for (int round = 0; round < 20000; ++round) {
    CAPTURE(seed, round);
    std::string bytes = good;
    for (std::uint64_t changes = round ? 1 + random() % 3 : 0; changes; --changes) {
      const std::size_t at = static_cast<std::size_t>(random() % bytes.size());
      if (random() % 2)
        bytes[at] = static_cast<char>(random());
      else
        std::memcpy(&bytes[at], &odd[random() % std::size(odd)], std::min<std::size_t>(4, bytes.size() - at));
    }
    std::size_t at = 0;
    const ByteSource source = [&](void* to, std::size_t count) {
      if (count > bytes.size() - at) throw Ended();
      std::memcpy(to, bytes.data() + at, count);
      at += count;
    };
    try {
      const ExrFile back = receive_exr(source, "x.exr", max_bytes);
      ++sound;
      REQUIRE(back.picture.pixel_count() * back.picture.channels.size() * 4 <= max_bytes);
      for (const Picture::Channel& channel : back.picture.channels)
        REQUIRE(channel.words.size() == back.picture.pixel_count());
    } catch (const Error&) {
      ++refused;
    } catch (const Ended&) {
      ++refused;
    }
  }
  CHECK(sound > 100);
  CHECK(refused > 100);
}
