// Foreign OpenEXR files: what is read right, what is refused, and what becomes of a bad reader process.
#include "levelray/io/exr_reader.hpp"
#include "levelray/core/error.hpp"
#include "support/catch.hpp"
#include "support/fake_reader.hpp"
#include "support/read_output.hpp"
#include "support/write_exr.hpp"

#include <ImfDeepFrameBuffer.h>
#include <ImfDeepScanLineOutputFile.h>
#include <ImfOpaqueAttribute.h>
#include <chrono>
#include <cmath>
#include <limits>
#include <random>

using namespace levelray;
using namespace levelray::test;
using Type = Picture::Type;

namespace {

// Channels of all types, with NaN, infinities and integers that no float holds.
Picture sample_picture() {
  Picture picture = blank_picture({{-3, 7}, {33, 46}}, {{0, 0}, {63, 47}},
                                  {{"A", Type::half}, {"N.x", Type::float32}, {"id", Type::uint32}});
  std::mt19937 random(3);
  std::uniform_real_distribution<float> value(-2, 2);
  for (std::size_t i = 0; i < picture.pixel_count(); ++i) {
    set(picture.channels[0], i, half(value(random)));
    set(picture.channels[1], i, value(random));
    picture.channels[2].words[i] = static_cast<std::uint32_t>(random());
  }
  const float inf = std::numeric_limits<float>::infinity();
  set(picture.channels[0], 5, inf);
  set(picture.channels[1], 6, -inf);
  set(picture.channels[1], 7, std::numeric_limits<float>::quiet_NaN());
  set(picture.channels[1], 8, -0.0f);
  return picture;
}

void check_same(const Picture& read, const Picture& written) {
  CHECK(read.data_window == written.data_window);
  CHECK(read.display_window == written.display_window);
  REQUIRE(read.channels.size() == written.channels.size());
  for (std::size_t c = 0; c < read.channels.size(); ++c) {
    CAPTURE(c);
    CHECK(read.channels[c].name == written.channels[c].name);
    CHECK(read.channels[c].type == written.channels[c].type);
    CHECK((read.channels[c].words == written.channels[c].words)); // bit for bit
  }
}

std::pair<ErrorKind, std::string> error_of(const std::string& path, const ExrReadOptions& options = {}) {
  try {
    read_exr(path, options);
  } catch (const Error& error) {
    return {error.kind(), error.what()};
  }
  return {ErrorKind::usage, "no error"};
}

void check_refused(const std::string& path, const std::string& reason) {
  const auto [kind, text] = error_of(path);
  CHECK(kind == ErrorKind::bad_input);
  CHECK_THAT(text, Catch::StartsWith(path + ": ") && Catch::Contains(reason));
}

// The first occurrence of `from` in the file's bytes becomes `to`, which is as long.
void patch(const std::string& path, const std::string& from, const std::string& to) {
  std::string bytes = content_of(path);
  const std::size_t at = bytes.find(from);
  REQUIRE(at != std::string::npos);
  REQUIRE(from.size() == to.size());
  bytes.replace(at, from.size(), to);
  std::ofstream(path, std::ios::binary) << bytes;
}

std::string little_endian(std::initializer_list<std::int32_t> numbers) {
  std::string bytes;
  for (const std::int32_t n : numbers) bytes.append(reinterpret_cast<const char*>(&n), 4);
  return bytes;
}

} // namespace

TEST_CASE("scan lines and tiles of every lossless compression are read bit for bit") {
  const TemporaryFolder dir;
  const Picture picture = sample_picture();
  for (const Imf::Compression compression : {Imf::NO_COMPRESSION, Imf::RLE_COMPRESSION, Imf::ZIPS_COMPRESSION,
                                             Imf::ZIP_COMPRESSION, Imf::PIZ_COMPRESSION})
    for (const auto& [tiled, mipmaps] : {std::pair{false, false}, {true, false}, {true, true}}) {
      CAPTURE(compression, tiled, mipmaps);
      write_exr(dir / "a.exr", picture, {compression, tiled, mipmaps});
      check_same(read_exr(dir / "a.exr").picture, picture);
      ExrReadOptions trusted;
      trusted.trust_input = true;
      check_same(read_exr(dir / "a.exr", trusted).picture, picture);
    }
}

TEST_CASE("lossy compressions are read as OpenEXR reads them") {
  const TemporaryFolder dir;
  const Picture picture = blank_picture(40, 300, {{"Y", Type::half}, {"Z", Type::float32}});
  for (const Imf::Compression compression :
       {Imf::PXR24_COMPRESSION, Imf::B44_COMPRESSION, Imf::B44A_COMPRESSION, Imf::DWAA_COMPRESSION,
        Imf::DWAB_COMPRESSION}) {
    CAPTURE(compression);
    write_exr(dir / "a.exr", picture, {compression, false, false});
    check_same(read_exr(dir / "a.exr").picture, picture); // zeros survive all of them
  }
}

TEST_CASE("the first of several parts is read, with a warning") {
  const TemporaryFolder dir;
  const Picture first = sample_picture();
  const Picture second = blank_picture({{1, 1}, {3, 2}}, first.display_window, {{"Y", Type::half}});
  write_parts(dir / "a.exr", {first, second});
  const ExrFile file = read_exr(dir / "a.exr");
  check_same(file.picture, first);
  REQUIRE(file.warnings.size() == 1);
  CHECK_THAT(file.warnings[0], Catch::EndsWith("has 2 parts; the first, \"part0\", is read"));
}

TEST_CASE("what cannot be compared pixel by pixel is refused") {
  const TemporaryFolder dir;
  Imf::Header header(8, 8);
  header.channels().insert("Y", Imf::Channel(Imf::HALF));
  header.channels().insert("BY", Imf::Channel(Imf::HALF, 2, 2));
  std::vector<half> values(64);
  {
    Imf::FrameBuffer buffer;
    buffer.insert("Y", Imf::Slice(Imf::HALF, reinterpret_cast<char*>(values.data()), 2, 16));
    buffer.insert("BY", Imf::Slice(Imf::HALF, reinterpret_cast<char*>(values.data()), 2, 8, 2, 2));
    Imf::OutputFile file((dir / "subsampled.exr").c_str(), header);
    file.setFrameBuffer(buffer);
    file.writePixels(8);
  }
  check_refused(dir / "subsampled.exr", "channel \"BY\" is stored for every 2 x 2 pixels only");

  Imf::Header deep(2, 1);
  deep.channels().insert("Z", Imf::Channel(Imf::FLOAT));
  deep.setType(Imf::DEEPSCANLINE);
  deep.compression() = Imf::ZIPS_COMPRESSION;
  {
    unsigned int counts[2] = {1, 1};
    float z[2] = {1, 2};
    float* pointers[2] = {&z[0], &z[1]};
    Imf::DeepFrameBuffer buffer;
    buffer.insertSampleCountSlice(
        Imf::Slice(Imf::UINT, reinterpret_cast<char*>(counts), sizeof(unsigned), 2 * sizeof(unsigned)));
    buffer.insert("Z", Imf::DeepSlice(Imf::FLOAT, reinterpret_cast<char*>(pointers), sizeof(float*),
                                      2 * sizeof(float*), sizeof(float)));
    Imf::DeepScanLineOutputFile file((dir / "deep.exr").c_str(), deep);
    file.setFrameBuffer(buffer);
    file.writePixels(1);
  }
  check_refused(dir / "deep.exr", "deep pixels");
}

TEST_CASE("a truncated file is refused, wherever it ends") {
  const TemporaryFolder dir;
  write_exr(dir / "a.exr", sample_picture());
  const std::string whole = content_of(dir / "a.exr");
  for (const std::size_t size : {std::size_t{1}, std::size_t{7}, std::size_t{20}, std::size_t{300},
                                 whole.size() / 2, whole.size() - 1}) {
    CAPTURE(size, whole.size());
    std::ofstream(dir / "b.exr", std::ios::binary) << whole.substr(0, size);
    const auto [kind, text] = error_of(dir / "b.exr");
    CHECK(kind == ErrorKind::bad_input);
    CHECK(text.size() <= Error::max_length);
  }
}

TEST_CASE("headers that lie are refused before memory is taken") {
  const TemporaryFolder dir;
  const std::string path = dir / "a.exr";
  const std::string window = std::string("dataWindow\0box2i\0", 17) + little_endian({16, 0, 0, 7, 3}),
                    name = window.substr(0, 21);
  const auto with_window = [&](std::initializer_list<std::int32_t> corners) {
    write_exr(path, blank_picture(8, 4, {{"Y", Type::half}}), {Imf::NO_COMPRESSION, false, false});
    patch(path, window, name + little_endian(corners));
  };
  with_window({0, 0, 1 << 30, 3});
  check_refused(path, "sides must be 1 to 1048576");
  with_window({std::numeric_limits<int>::min(), 0, std::numeric_limits<int>::max(), 3});
  check_refused(path, "sides must be 1 to 1048576");
  with_window({5, 0, 4, 3});
  check_refused(path, "sides must be 1 to 1048576");
  with_window({0, 0, 7, 999});
  check_refused(path, "announces 1000 chunks");
  with_window({0, 0, (1 << 20) - 1, 3});
  check_refused(path, "times its size");

  const Picture picture = blank_picture(8, 4, {{"Y", Type::half}});
  write_exr(path, picture);
  patch(path, "displayWindow", "displayWindoW");
  check_refused(path, "attribute \"displayWindow\" is missing");
  write_exr(path, picture);
  patch(path, std::string("compression\0compression\0\1\0\0\0", 28),
        std::string("compression\0compression\0\1\0\0\x7f", 28));
  check_refused(path, "attribute \"compression\" announces 2130706433 bytes");
  write_exr(path, picture);
  patch(path, std::string("compression\0compression\0\1\0\0\0\3", 29),
        std::string("compression\0compression\0\1\0\0\0\x37", 29));
  check_refused(path, "compression 55 is unknown");
  write_exr(path, blank_picture(8, 4, {{"Y", Type::half}, {"Z", Type::half}}));
  patch(path, std::string("Z\0\1\0\0\0", 6), std::string("Y\0\1\0\0\0", 6));
  check_refused(path, "channel \"Y\" comes twice");
  write_exr(path, picture, {Imf::ZIP_COMPRESSION, true, false});
  patch(path, std::string("tiledesc\0", 9) + little_endian({9, 16, 8}),
        std::string("tiledesc\0", 9) + little_endian({9, 1 << 30, 8}));
  check_refused(path, "tiles of 1073741824 x 8");
}

TEST_CASE("a picture beyond the memory limit is refused with its size") {
  const TemporaryFolder dir;
  write_exr(dir / "a.exr", blank_picture(4000, 3000, {{"Y", Type::half}, {"Z", Type::float32}}));
  ExrReadOptions options;
  options.max_memory = std::uint64_t{100} << 20; // 96 MB of values, and what OpenEXR takes
  const auto [kind, text] = error_of(dir / "a.exr", options);
  CHECK(kind == ErrorKind::limit);
  CHECK_THAT(text, Catch::Contains("4000 x 3000 pixels, 2 channels") && Catch::Contains("--max-memory"));
  options.max_memory = std::uint64_t{1} << 30;
  CHECK(read_exr(dir / "a.exr", options).picture.pixel_count() == 12000000);
}

TEST_CASE("whatever the reader of pictures does, the parent ends with one line of the right kind") {
  const TemporaryFolder dir;
  const std::string path = dir / "a.exr";
  write_exr(path, sample_picture());
  const auto answer = [&](const std::string& script, const ExrReadOptions& options = {}) {
    const FakeReader fake("LEVELRAY_EXR_READER", dir, script);
    return error_of(path, options);
  };
  using Expected = std::pair<ErrorKind, std::string>;
  CHECK(
      answer("kill -SEGV $$") ==
      Expected(ErrorKind::bad_input, path + ": reader crashed (signal 11); the file is damaged or hostile"));
  CHECK(answer("exit 7") ==
        Expected(ErrorKind::bad_input, path + ": the reader ended without an answer (status 7)"));
  CHECK(answer("cat /dev/zero").first == ErrorKind::bad_input);
  ExrReadOptions brief;
  brief.timeout_seconds = 0.2;
  const auto start = std::chrono::steady_clock::now();
  CHECK(answer("exec sleep 20", brief) ==
        Expected(ErrorKind::limit, path + ": reading took longer than 0.2 s and was stopped"));
  CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(5));
  CHECK(error_of(dir / "missing.exr") == Expected(ErrorKind::bad_input, dir / "missing.exr: no such file"));
  CHECK(error_of(dir.path()) == Expected(ErrorKind::bad_input, dir.path() + ": is a directory"));
  std::ofstream(dir / "text.exr") << "no picture";
  CHECK(error_of(dir / "text.exr") == Expected(ErrorKind::bad_input, dir / "text.exr: not an OpenEXR file"));
}
