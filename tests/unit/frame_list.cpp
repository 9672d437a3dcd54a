#include "levelray/io/frame_list.hpp"
#include "levelray/core/error.hpp"
#include "levelray/io/frame_pattern.hpp"
#include "support/catch.hpp"
#include "support/mesh_files.hpp"
#include "support/temporary_folder.hpp"

#include <filesystem>

using namespace levelray;
using namespace levelray::test;

namespace {

using Frames = std::vector<int>;

Frames frames(const std::string& text) {
  return parse_frames("-f", text);
}

} // namespace

TEST_CASE("a list of frames holds numbers, ranges and steps in the order they are written") {
  CHECK(frames("7") == Frames{7});
  CHECK(frames("007") == Frames{7});
  CHECK(frames("-0") == Frames{0});
  CHECK(frames("3-6") == Frames{3, 4, 5, 6});
  CHECK(frames("1001-1009x4") == Frames{1001, 1005, 1009});
  CHECK(frames("1001-1010@4") == Frames{1001, 1005, 1009});
  CHECK(frames("5-5") == Frames{5});
  CHECK(frames("1-3x100") == Frames{1});
  CHECK(frames("9, 1-3,20") == Frames{9, 1, 2, 3, 20});
  CHECK(frames("-3--1") == Frames{-3, -2, -1});
  CHECK(frames("-2-1") == Frames{-2, -1, 0, 1});
  CHECK(frames("-10--1x5,-8") == Frames{-10, -5, -8});
  CHECK(frames("1-9x4,1-5") == Frames{1, 5, 9, 2, 3, 4}); // a coarse look first; nothing twice
  CHECK(frames("-999999999,999999999") == Frames{-999999999, 999999999});
  CHECK(frames("1-1000000").size() == max_frames);
}

TEST_CASE("what is no list of frames is refused in one line") {
  const char* bad[] = {"",     ",",      "1,",     "a",          "1-",          "1-b",    "1--",
                       "--1",  "1-2-3",  "1-5x",   "1-5x0",      "5x2",         "1-5x-1", "1-5@",
                       "1.5",  "+1",     "0x10",   "1 2",        "5-1",         "-1--5",  "1;2",
                       "####", "1-5xx2", "1-5 x2", "1000000000", "1-1000000000"};
  for (const char* text : bad) {
    INFO(text);
    try {
      frames(text);
      FAIL_CHECK("was taken");
    } catch (const Error& error) {
      CHECK(error.kind() == ErrorKind::usage);
      CHECK_THAT(error.what(), Catch::StartsWith("-f "));
    }
  }
  CHECK_THROWS_WITH(frames("5-1"), Catch::Contains("runs backwards; write 1-5"));
  CHECK_THROWS_WITH(frames("0-999999999"), Catch::Contains("more than 1000000 frames"));
  CHECK_THROWS_WITH(frames("-999999999-999999999"), Catch::Contains("more than 1000000 frames"));
  CHECK_THROWS_WITH(frames("1-600000,-600000--1"), Catch::Contains("more than 1000000 frames"));
}

TEST_CASE("frames are told as briefly as they can be typed") {
  CHECK(frames_text({}) == "");
  CHECK(frames_text({4}) == "4");
  CHECK(frames_text({4, 5}) == "4-5");
  CHECK(frames_text({4, 6}) == "4, 6");
  CHECK(frames_text({1, 2, 3, 7, 10, 12, 14}) == "1-3, 7, 10-14x2");
  CHECK(frames_text({-3, -2, -1, 0}) == "-3-0");
  CHECK(frames(frames_text({-9, -7, -5, 1, 2, 4})) == Frames{-9, -7, -5, 1, 2, 4});
  Frames many;
  for (int i = 0; i < 1000; ++i) many.push_back(i * i);
  CHECK(frames_text(many, 50).size() < 80);
  CHECK_THAT(frames_text(many, 50), Catch::EndsWith("... (1000 frames)"));
}

TEST_CASE("a pattern puts the frame's number into a path") {
  CHECK(FramePattern("a.####.vdb").path(7) == "a.0007.vdb");
  CHECK(FramePattern("a.####.vdb").path(-10) == "a.-0010.vdb");
  CHECK(FramePattern("a.####.vdb").path(123456) == "a.123456.vdb");
  CHECK(FramePattern("#").path(0) == "0");
  CHECK(FramePattern("d_##/a.vdb").path(3) == "d_03/a.vdb");
  CHECK(FramePattern("a.%04d.vdb").path(7) == "a.0007.vdb");
  CHECK(FramePattern("a.%04d.vdb").path(-10) == "a.-010.vdb"); // as printf("%04d", -10)
  CHECK(FramePattern("a.%04d.vdb").path(123456) == "a.123456.vdb");
  CHECK(FramePattern("a%d").path(-12) == "a-12");
  CHECK(FramePattern("a{frame}.obj").path(-12) == "a-12.obj");
  for (const char* plain : {"a.vdb", "100%.obj", "a%s.obj", "50%d", "{frames}", "%4d", "%-4d"}) {
    const FramePattern pattern(plain);
    const bool is_pattern = std::string(plain) == "50%d";
    CHECK(pattern.has_frame() == is_pattern);
    if (!is_pattern) CHECK(pattern.path(5) == plain);
  }
  for (const char* two : {"##.##", "a#/b#", "%d%d", "{frame}#", "#%02d"})
    CHECK_THROWS_WITH(FramePattern(two), Catch::Contains("two places for the frame's number"));
}

TEST_CASE("a pattern finds the frames that exist") {
  const TemporaryFolder folder;
  for (const char* name : {"a.0001.vdb", "a.0003.vdb", "a.-0002.vdb", "a.12345.vdb", "a.00004.vdb", "a.5.vdb",
                           "a.000x.vdb", "b.0006.vdb", "a.0007.obj", "a..vdb", "a.9999999999999.vdb"})
    write_text(folder / name, "x");
  CHECK(FramePattern(folder / "a.####.vdb").existing() == Frames{-2, 1, 3, 12345});
  CHECK(FramePattern(folder / "a.{frame}.vdb").existing() == Frames{5, 12345});
  CHECK(FramePattern(folder / "c.####.vdb").existing().empty());
  CHECK(FramePattern(folder / "missing/c.####.vdb").existing().empty());
  CHECK(FramePattern(folder / "a.0001.vdb").existing().empty());
  for (const char* name : {"s01", "s02"}) std::filesystem::create_directory(folder / name);
  write_text(folder / "s02/x.obj", "x");
  CHECK(FramePattern(folder / "s##/x.obj").existing() == Frames{2});
}
