// Sequences of frames: what is made, what is left alone, what is told.
#include "support/catch.hpp"
#include "support/sequence_job.hpp"

#include <filesystem>
#include <png.h>

using namespace levelray::test;
namespace fs = std::filesystem;

namespace {

Arguments render_boxes(const TemporaryFolder& in, const TemporaryFolder& out, const std::string& frames) {
  return {"render", in / "in.####.obj", "--resolution", "16", "--size", "24x16", "-f", frames,
          "-o",     out / "x.####.exr"};
}

} // namespace

TEST_CASE("convert and render go through sequences, and tell every frame on a line of JSON") {
  const TemporaryFolder folder;
  write_boxes(folder, -1, 3);
  const RunResult converted = run_program(
      {"convert", folder / "in.%04d.obj", folder / "grid.####.vdb", "-f", "1-3", "--resolution", "16"});
  INFO(converted.err);
  CHECK(converted.code == 0);
  CHECK_THAT(converted.out, Catch::Contains("frame 2: wrote ") && Catch::Contains("3 frames: 3 converted"));

  const RunResult rendered =
      run_program({"render", folder / "grid.####.vdb", "-f", "1-3x2,2", "-o", folder / "x.{frame}.exr", "-o",
                   folder / "x.%04d.png", "--size", "24x16", "--json", "-", "-j", "2"});
  INFO(rendered.err << rendered.out);
  CHECK(rendered.code == 0);
  const std::vector<Json> lines = json_lines(rendered.out);
  REQUIRE(lines.size() == 4);
  CHECK(lines[0]["frame"] == 1);
  CHECK(lines[1]["frame"] == 3); // in the order they were asked for
  CHECK(lines[2]["frame"] == 2);
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(keys(lines[i]) == std::set<std::string>{"frame", "status", "input", "output", "scene_hash", "ms",
                                                  "rays", "hits", "warnings"});
    CHECK(lines[i]["status"] == "rendered");
    CHECK(lines[i]["hits"] > 20);
    for (const auto& output : lines[i]["output"]) CHECK(fs::exists(output));
  }
  CHECK(lines[1]["output"] == Json({folder / "x.3.exr", folder / "x.0003.png"}));
  const Json& summary = lines[3]["summary"];
  CHECK(summary["frames"] == 3);
  CHECK(summary["rendered"] == 3);
  CHECK(summary["failed"].empty());
  CHECK(summary["frames_per_minute"] > 0);
  CHECK(summary["peak_memory"] > 1000000);
  CHECK(lines[3]["camera_frames"] == Json({1, 3, 2}));
  CHECK(lines[3]["options"]["frames"] == "1-3x2,2");
}

TEST_CASE("a frame of a sequence has the same bytes whatever else is rendered") {
  const TemporaryFolder in, all, some;
  write_boxes(in, 1, 6);
  CHECK(run_program(render_boxes(in, all, "1-6") + Arguments{"--ground", "-j", "1"}).code == 0);
  const RunResult part = run_program(render_boxes(in, some, "5,3") +
                                     Arguments{"--ground", "--camera-frames", "1,3,6", "-j", "2"});
  CHECK(part.code == 0);
  CHECK_THAT(part.out, Catch::Contains("camera and ground: by frames 1, 3, 6"));
  for (const char* name : {"x.0003.exr", "x.0005.exr"})
    CHECK((content_of(all / name) == content_of(some / name)));
  CHECK((content_of(all / "x.0003.exr") != content_of(all / "x.0005.exr")));
}

TEST_CASE("frames, patterns and outputs that cannot be meant end with 2 before any work") {
  const TemporaryFolder folder;
  write_boxes(folder, 1, 3);
  const std::string in = folder / "in.####.obj", out = folder / "x.####.png", one = folder / "in.0001.obj";
  struct Case {
    Arguments arguments;
    std::string says;
    int code = 2;
  };
  const Case cases[] = {
      {{"render", in, "-o", out}, "found 1-3, add -f 1-3"},
      {{"render", one, "-o", out}, "needs -f"},
      {{"render", folder / "no.####.obj", "-o", folder / "x.png"}, "found none"},
      {{"render", folder / "in.##.%d.obj", "-f", "1", "-o", out}, "two places"},
      {{"render", in, "-f", "1", "-o", folder / "##.##.png"}, "two places"},
      {{"render", in, "-f", "3-1", "-o", out}, "runs backwards"},
      {{"render", in, "-f", "0-999999999", "-o", out}, "more than 1000000 frames"},
      {{"render", in, "-f", "1,b", "-o", out}, "is no frame"},
      {{"render", in, "-f", "1-3", "-o", folder / "x.png"}, "one file for 3 frames"},
      {{"render", in, "-f", "1-3", "-o", out, "-o", folder / "y.png"}, "one file for 3 frames"},
      {{"render", in, "-f", "1-3", "-o", out, "-o", out}, "is written twice"},
      {{"render", in, "-f", "1-3", "-o", folder / "no/x.####.png"}, "folder does not exist"},
      {{"render", in, "-f", "1-3", "-o", folder / "s####/x.png"}, "folder does not exist"},
      {{"render", in, "-f", "1-3", "-o", folder / "x.####.jpg"}, "unknown output extension"},
      {{"render", in, "-f", "1-3", "-o", out, "--missing", "hlod"}, "did you mean \"hold\""},
      {{"render", in, "-f", "1-3", "-o", out, "--turntable", "3"}, "round one input"},
      {{"render", in, "-f", "1-3", "-o", out, "--movie", folder / "x.gif"}, "unknown movie extension"},
      {{"render", in, "-f", "1-3", "-o", out, "--movie", folder / "x.mp4", "--fps", "0"}, "--fps 0"},
      {{"render", in, "-f", "1-3", "-o", out, "--camera-frames", "x"}, "--camera-frames"},
      {{"convert", in, folder / "x.vdb", "-f", "1-3"}, "one file for 3 frames"},
      {{"convert", in, folder / "x.vdb"}, "found 1-3"},
      {{"render", in, "-f", "7-9", "-o", out}, "found 1-3", 3},
  };
  for (const Case& c : cases) {
    const RunResult result = run_program(c.arguments);
    INFO(c.arguments.back() << ": " << result.err);
    CHECK(result.code == c.code);
    CHECK_THAT(result.err, Catch::Contains(c.says));
    CHECK(std::count(result.err.begin(), result.err.end(), '\n') == 1);
  }
  CHECK(folder.names() == Names{"in.0001.obj", "in.0002.obj", "in.0003.obj"});

  // A name with '#' that exists is a name.
  write_text(folder / "part#1.obj", box_obj(1, 1, 1));
  CHECK(run_program(
            {"render", folder / "part#1.obj", "-o", folder / "y.png", "--resolution", "9", "--size", "9x9"})
            .code == 0);
}

TEST_CASE("negative frames and frames wider than the padding are numbered as others do") {
  const TemporaryFolder folder;
  for (const char* name : {"a.-0010.obj", "a.-0009.obj", "a.12345.obj"})
    write_text(folder / name, box_obj(1, 1, 1));
  const Arguments job{"convert", folder / "a.####.obj", folder / "b.{frame}.vdb", "--resolution", "9"};
  CHECK(run_program(job + Arguments{"-f", "-10--9"}).code == 0);
  CHECK(run_program(job + Arguments{"-f", "12345"}).code == 0);
  for (const char* name : {"b.-10.vdb", "b.-9.vdb", "b.12345.vdb"}) CHECK(fs::exists(folder / name));
}

TEST_CASE("missing inputs are errors, skipped or held") {
  const TemporaryFolder in;
  write_boxes(in, 1, 5);
  fs::remove(in / "in.0003.obj");
  {
    const TemporaryFolder out;
    const RunResult result = run_program(render_boxes(in, out, "1-6") + Arguments{"--json", "-"});
    CHECK(result.code == 4);
    CHECK_THAT(result.err, Catch::Contains("2 of 6 frames failed: 3, 6") && Catch::Contains("no such file"));
    CHECK(statuses(result.out) == std::map<int, std::string>{{1, "rendered"},
                                                             {2, "rendered"},
                                                             {3, "failed"},
                                                             {4, "rendered"},
                                                             {5, "rendered"},
                                                             {6, "failed"}});
    CHECK(out.names() == Names{"x.0001.exr", "x.0002.exr", "x.0004.exr", "x.0005.exr"});
  }
  {
    const TemporaryFolder out;
    const RunResult result =
        run_program(render_boxes(in, out, "1-6") + Arguments{"--missing", "skip", "--json", "-"});
    CHECK(result.code == 0);
    CHECK(json_lines(result.out).back()["summary"]["missing"] == Json({3, 6}));
    CHECK(out.names().size() == 4);
  }
  {
    const TemporaryFolder out;
    const RunResult result =
        run_program(render_boxes(in, out, "0-6") + Arguments{"--missing", "hold", "--json", "-"});
    CHECK(result.code == 4); // nothing to hold at 0
    CHECK_THAT(result.err, Catch::Contains("no earlier frame"));
    const std::vector<Json> lines = json_lines(result.out);
    CHECK(lines[3]["held"] == true);
    CHECK(lines[3]["input"] == Json({in / "in.0002.obj"}));
    CHECK(out.names().size() == 6);
    // The frames that are held begin where -f does not.
    const TemporaryFolder part;
    CHECK(run_program(render_boxes(in, part, "3") + Arguments{"--missing", "hold", "--camera-frames", "1-6"})
              .code == 0);
    CHECK((content_of(part / "x.0003.exr") == content_of(out / "x.0003.exr")));
  }
}

TEST_CASE(
    "--skip-existing renders what is missing, cut, of other inputs or of other options, and nothing else") {
  const TemporaryFolder in, out, unbroken;
  write_boxes(in, 1, 6);
  const Arguments job =
      render_boxes(in, out, "1-6") + Arguments{"-o", out / "x.####.png", "--skip-existing", "--json", "-"};
  const auto rendered = [&](const Arguments& more = {}) {
    const RunResult result = run_program(job + more);
    INFO(result.err);
    CHECK(result.code == 0);
    std::set<int> frames;
    for (const auto& [frame, status] : statuses(result.out))
      if (status == "rendered") frames.insert(frame);
    return frames;
  };
  CHECK(rendered() == std::set<int>{1, 2, 3, 4, 5, 6});
  CHECK(rendered().empty());
  CHECK(rendered({"--threads", "1", "--max-memory", "4GB", "--trust-input"}).empty());

  fs::remove(out / "x.0002.exr");
  fs::resize_file(out / "x.0003.exr", fs::file_size(out / "x.0003.exr") - 1);
  write_text(out / "x.0004.png", "somebody else's");
  // The same size and time as before, but other bytes.
  const auto time = fs::last_write_time(in / "in.0005.obj");
  write_text(in / "in.0005.obj", box_obj(1.6, 1, 0.5));
  fs::last_write_time(in / "in.0005.obj", time);
  CHECK(rendered() == std::set<int>{2, 3, 4, 5});
  CHECK(rendered().empty());

  // A picture under another frame's name is that frame's only by its name.
  fs::copy_file(out / "x.0001.exr", out / "x.0006.exr", fs::copy_options::overwrite_existing);
  CHECK(rendered() == std::set<int>{6});
  CHECK(rendered({"--shadows"}).size() == 6);
  CHECK(rendered({"--aov", "Z"}).size() == 6);
  CHECK(rendered({"--fov", "40"}).size() == 6);
  CHECK(rendered().size() == 6);
  CHECK(run_program(render_boxes(in, unbroken, "1-6") + Arguments{"-o", unbroken / "x.####.png"}).code == 0);
  CHECK((contents(out) == contents(unbroken)));

  // Conversion, too, and a single picture.
  const Arguments convert{"convert", in / "in.####.obj", out / "g.####.vdb", "-f", "1-3", "--resolution",
                          "9",       "--skip-existing",  "--json",           "-"};
  CHECK(count(statuses(run_program(convert).out), "converted") == 3);
  CHECK(count(statuses(run_program(convert).out), "skipped") == 3);
  CHECK(count(statuses(run_program(convert + Arguments{"--half"}).out), "converted") == 3);
  const Arguments single{"render", in / "in.0001.obj", "-o", out / "one.png",  "--size",
                         "9x9",    "--resolution",     "9",  "--skip-existing"};
  CHECK_THAT(run_program(single).out, Catch::Contains("1 rendered"));
  CHECK_THAT(run_program(single).out, Catch::Contains("1 skipped"));
}

TEST_CASE("a turntable goes round once, seeing all of the object, and stops where it is told to") {
  const TemporaryFolder folder;
  write_text(folder / "box.obj", box_obj(4, 1, 0.3));
  const Arguments job{
      "render", folder / "box.obj",    "--turntable", "8", "--resolution", "40", "--size", "64x48",
      "-o",     folder / "t.####.png", "--json",      "-"};
  const RunResult result = run_program(job);
  INFO(result.err);
  CHECK(result.code == 0);
  CHECK(count(statuses(result.out), "rendered") == 8);
  std::set<std::string> different;
  for (int frame = 1; frame <= 8; ++frame) {
    const std::string path = folder / ("t.000" + std::to_string(frame) + ".png");
    different.insert(content_of(path));
    png_image png = {};
    png.version = PNG_IMAGE_VERSION;
    REQUIRE(png_image_begin_read_from_file(&png, path.c_str()));
    png.format = PNG_FORMAT_RGBA;
    std::vector<std::uint8_t> pixels(PNG_IMAGE_SIZE(png));
    REQUIRE(png_image_finish_read(&png, nullptr, pixels.data(), 0, nullptr));
    int border = 0, inside = 0;
    for (int y = 0; y < 48; ++y)
      for (int x = 0; x < 64; ++x)
        if (pixels[static_cast<std::size_t>(4 * (64 * y + x) + 3)] > 0)
          ++(x == 0 || y == 0 || x == 63 || y == 47 ? border : inside);
    CHECK(border == 0);
    CHECK(inside > 150);
  }
  CHECK(different.size() == 8);

  const TemporaryFolder some;
  CHECK(run_program({"render", folder / "box.obj", "--turntable", "8", "--resolution", "40", "--size",
                     "64x48", "-o", some / "t.####.png", "-f", "3-5x2"})
            .code == 0);
  CHECK(some.names() == Names{"t.0003.png", "t.0005.png"});
  for (const std::string& name : some.names()) CHECK((content_of(some / name) == content_of(folder / name)));
}

TEST_CASE("frames that fit --max-memory alone but not side by side are loaded one after the other") {
  const TemporaryFolder in, out, free;
  for (int frame = 1; frame <= 3; ++frame)
    write_text(in / ("b" + std::to_string(frame) + ".obj"), ball_obj(20 + frame));
  CHECK(run_program({"convert", in / "b#.obj", in / "b#.vdb", "-f", "1-3", "--resolution", "120"}).code == 0);
  const auto job = [&](const TemporaryFolder& to) {
    return Arguments{"render",      in / "b#.vdb", "-f",    "1-3",    "-o",
                     to / "x#.png", "--size",      "16x16", "--json", "-"};
  };
  CHECK(run_program(job(free)).code == 0);
  const std::uint64_t grid =
      Json::parse(run_program({"convert", in / "b1.obj", in / "x.vdb", "--resolution", "120", "--json", "-"})
                      .out)["grid"]["bytes"];
  // Room for a grid, its level set and the picture, but not for a second grid. The reader's own limit of
  // address space (vdb/reader) would be below what a process needs to begin.
  const RunResult tight =
      run_program(job(out) + Arguments{"--trust-input", "--max-memory", std::to_string(grid * 9 / 4)});
  INFO(tight.err);
  CHECK(tight.code == 0);
  CHECK((contents(out) == contents(free)));
  const RunResult too_tight =
      run_program(job(out) + Arguments{"--trust-input", "--max-memory", std::to_string(grid / 2)});
  CHECK(too_tight.code != 0);
}

TEST_CASE("a frame that takes longer than --frame-timeout is given up, and the others go on") {
  const TemporaryFolder folder;
  for (const char* name : {"in.1.obj", "in.3.obj"}) write_text(folder / name, box_obj(0.02, 0.02, 0.02));
  write_text(folder / "in.2.obj", ball_obj(60)); // 50 times as large: some ten million voxels of surface
  const Arguments job{"convert",
                      folder / "in.#.obj",
                      folder / "x.#.vdb",
                      "-f",
                      "1-3",
                      "--voxel",
                      "0.0005",
                      "--frame-timeout",
                      "1",
                      "--max-memory",
                      "0",
                      "--json",
                      "-"};
  const RunResult result = run_program(job);
  INFO(result.err);
  CHECK(result.code == 4);
  CHECK_THAT(result.err, Catch::Contains("frame 2: took longer than --frame-timeout 1"));
  CHECK(statuses(result.out) ==
        std::map<int, std::string>{{1, "converted"}, {2, "failed"}, {3, "converted"}});
  CHECK(folder.names() == Names{"in.1.obj", "in.2.obj", "in.3.obj", "x.1.vdb", "x.3.vdb"});
}
