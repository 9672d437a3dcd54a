#include "levelray/io/scene_stamp.hpp"

#include "levelray/io/exr_writer.hpp"
#include "levelray/io/png_writer.hpp"
#include "levelray/vdb/vdb_file.hpp"
#include "support/catch.hpp"
#include "support/mesh_files.hpp"
#include "support/read_output.hpp"
#include "support/sphere_grid.hpp"
#include "support/temporary_folder.hpp"

#include <filesystem>

using namespace levelray;
using namespace levelray::test;

namespace {

const std::string mine = "01234567-89ab-8def-8123-456789abcdef",
                  other = "fedcba98-7654-8210-8edc-ba9876543210";

Image small_image() {
  Image image{7, 5, {}};
  for (const char* name : {"R", "G", "B", "A", "Z"}) {
    float value = 0;
    for (float& v : image.add(name)) v = value += 0.01f;
  }
  return image;
}

// Stamped files of all kinds, by extension.
std::vector<std::string> stamped_files(const TemporaryFolder& folder) {
  const std::string exr = folder / "a.exr", png = folder / "a.png", vdb = folder / "a.vdb";
  ExrOptions options;
  options.frame = -7;
  options.scene_hash = mine;
  write_text(exr, encode_exr(small_image(), options));
  write_text(png, encode_png(small_image(), mine));
  VdbWriteOptions vdb_options;
  vdb_options.scene_hash = mine;
  write_vdb(vdb, sphere_grid(4), vdb_options);
  return {exr, png, vdb};
}

} // namespace

TEST_CASE("a stamped file is trusted for its own scene only") {
  const TemporaryFolder folder;
  for (const std::string& path : stamped_files(folder)) {
    INFO(path);
    CHECK(distrust(path, mine) == "");
    CHECK_THAT(distrust(path, other), Catch::Contains("other inputs or options"));
  }
  CHECK_THAT(distrust(folder / "b.exr", mine), Catch::Contains("does not exist"));
  CHECK_THAT(distrust(folder.path(), mine), Catch::Contains("no regular file"));
}

TEST_CASE("a stamped file that is cut, longer or changed in any byte is not trusted") {
  const TemporaryFolder folder;
  for (const std::string& path : stamped_files(folder)) {
    const std::string whole = content_of(path);
    INFO(path << ", " << whole.size() << " bytes");
    std::string trusted;
    for (std::size_t size = 0; size < whole.size(); ++size) {
      write_text(path, whole.substr(0, size));
      if (distrust(path, mine).empty()) trusted += " cut at " + std::to_string(size);
    }
    // Of long files some bytes, but all of the header and the end.
    for (std::size_t at = 0; at<whole.size(); at += at> 1200 && at + 200 < whole.size() ? 37 : 1) {
      std::string bytes = whole;
      bytes[at] = static_cast<char>(bytes[at] ^ 0x10);
      write_text(path, bytes);
      if (distrust(path, mine).empty()) trusted += " changed at " + std::to_string(at);
    }
    for (const std::string& more : {std::string(1, '\0'), whole}) {
      write_text(path, whole + more);
      if (distrust(path, mine).empty()) trusted += " longer";
    }
    CHECK(trusted == "");
    write_text(path, whole);
    CHECK(distrust(path, mine) == "");
  }
}

TEST_CASE("somebody else's files are told apart without being decoded") {
  const TemporaryFolder folder;
  const std::string path = folder / "x";
  ExrOptions plain;
  for (const std::string& bytes :
       {std::string(), std::string("\x76\x2F\x31\x01", 4), std::string("\x89PNG\r\n\x1A\n", 8),
        std::string(" BDV\0\0\0\0", 8), std::string(100000, '\0'), encode_exr(small_image(), plain),
        encode_png(small_image()), std::string("\x76\x2F\x31\x01", 4) + "levelray:scene_hash"}) {
    write_text(path, bytes);
    CHECK_FALSE(distrust(path, mine).empty());
  }
  const std::filesystem::path hostile = LEVELRAY_TESTDATA "/hostile-exr";
  if (!std::filesystem::exists(hostile)) {
    WARN("skipped: no damaged OpenEXR files in " LEVELRAY_TESTDATA);
    return;
  }
  for (const auto& entry : std::filesystem::directory_iterator(hostile))
    CHECK_FALSE(distrust(entry.path(), mine).empty());
}

TEST_CASE("the stamp says nothing but the scene and the content") {
  const TemporaryFolder folder;
  const std::vector<std::string> first = stamped_files(folder);
  const TemporaryFolder again;
  const std::vector<std::string> second = stamped_files(again);
  for (std::size_t i = 0; i < first.size(); ++i) CHECK(content_of(first[i]) == content_of(second[i]));
}
