// levelray compare: verdicts, exit codes, difference images, and hostile files.
#include "support/catch.hpp"
#include "support/mesh_files.hpp"
#include "support/read_exr.hpp"
#include "support/read_output.hpp"
#include "support/run_program.hpp"
#include "support/temporary_folder.hpp"
#include "support/write_exr.hpp"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <limits>
#include <sys/resource.h>

using namespace levelray;
using namespace levelray::test;
using Type = Picture::Type;

namespace {

// 4 x 3 pixels of 0.5, the second file with 0.5 more at (2, 1) in R.
struct TwoPictures {
  TwoPictures() {
    Picture picture = blank_picture(4, 3, {{"G", Type::float32}, {"R", Type::float32}});
    for (Picture::Channel& channel : picture.channels)
      for (std::size_t i = 0; i < 12; ++i) set(channel, i, 0.5f);
    write_exr(a, picture);
    set(picture.channels[1], 6, 1.0f);
    write_exr(b, picture);
  }
  TemporaryFolder folder;
  const std::string a = folder / "a.exr", b = folder / "b.exr";
};

Json json_of(std::vector<std::string> arguments, int code) {
  arguments.insert(arguments.begin(), "compare");
  arguments.insert(arguments.end(), {"--json", "-"});
  const RunResult result = run_program(arguments);
  INFO(result.err);
  CHECK(result.code == code);
  return Json::parse(result.out);
}

} // namespace

TEST_CASE("compare ends with 0 for equal pictures and with 6 for others") {
  const TwoPictures files;
  const RunResult same = run_program({"compare", files.a, files.a});
  CHECK(same.code == 0);
  CHECK(same.err.empty());
  CHECK_THAT(same.out, Catch::Contains("mean error 0, rms error 0, peak SNR inf dB"));
  const RunResult other = run_program({"compare", files.a, files.b});
  CHECK(other.code == 6);
  CHECK(other.err == "levelray: " + files.a + " and " + files.b +
                         ": 1 of 12 pixels differ by more than 1e-06, at most by 0.5\n");
  CHECK_THAT(other.out, Catch::Contains("max error 0.5 at (2, 1) in R\n") &&
                            Catch::Contains("1 of 12 pixels (8.33%) over 1e-06, 1 (8.33%) over 1e-06\n"));
  const RunResult quiet = run_program({"compare", files.a, files.b, "-q"});
  CHECK(quiet.out.empty());
  CHECK(quiet.err == other.err);
}

TEST_CASE("compare takes idiff's thresholds and tells all in JSON") {
  const TwoPictures files;
  const Json json = json_of({files.a, files.b}, 6);
  CHECK(json["verdict"] == "failure");
  CHECK(json["type"] == "exr");
  CHECK(json["failed"] == 1);
  CHECK(json["pixels"] == 12);
  CHECK(json["max_error"] == 0.5);
  CHECK(json["max_at"] == Json({2, 1}));
  CHECK(json["max_channel"] == "R");
  CHECK(json["mean_error"].get<double>() == Approx(0.5 / 24));
  CHECK(json["channels"]["G"]["max_error"] == 0.0);
  CHECK(json["channels"]["G"]["psnr"].is_null()); // infinite
  CHECK(json["options"]["fail"] == 1e-6);
  CHECK(json["options"]["hardfail"].is_null());

  CHECK(json_of({files.a, files.b, "--fail", "0.5"}, 0)["verdict"] == "warning");
  CHECK(json_of({files.a, files.b, "--fail", "0.5", "--warn", "0.5"}, 0)["verdict"] == "pass");
  CHECK(json_of({files.a, files.b, "--failpercent", "9"}, 0)["verdict"] == "warning");
  CHECK(json_of({files.a, files.b, "--failpercent", "9", "--warnpercent", "9"}, 0)["verdict"] == "pass");
  CHECK(json_of({files.a, files.b, "--failpercent", "8"}, 6)["verdict"] == "failure");
  CHECK(json_of({files.a, files.b, "--failpercent", "9", "--hardfail", "0.4"}, 6)["verdict"] == "failure");
  CHECK(json_of({files.a, files.b, "--allowfailures", "1"}, 0)["verdict"] == "warning");
  const RunResult warned = run_program({"compare", files.a, files.b, "--fail", "1", "-q"});
  CHECK(warned.code == 0);
  CHECK_THAT(warned.err,
             Catch::StartsWith("levelray: warning: ") && Catch::Contains("differ, within the limits"));
}

TEST_CASE("compare writes the difference, signed in .exr and coloured in .png") {
  const TwoPictures files;
  CHECK(run_program({"compare", files.a, files.b, "--diff", files.folder / "d.exr"}).code == 6);
  const ExrImage difference = read_exr(files.folder / "d.exr");
  CHECK(difference.width == 4);
  CHECK(difference.at("R")[6] == -0.5f);
  CHECK(difference.at("R")[5] == 0);
  CHECK(difference.at("G")[6] == 0);
  CHECK(run_program({"compare", files.a, files.b, "--diff", files.folder / "d.png"}).code == 6);
  CHECK_THAT(content_of(files.folder / "d.png"), Catch::StartsWith("\x89PNG"));
}

TEST_CASE("compare names sizes, channels and NaN that do not match") {
  const TwoPictures files;
  write_exr(files.folder / "small.exr", blank_picture(2, 3, {{"G", Type::half}, {"R", Type::half}}));
  const RunResult size = run_program({"compare", files.a, files.folder / "small.exr"});
  CHECK(size.code == 6);
  CHECK_THAT(size.err, Catch::EndsWith("different sizes: 4 x 3 and 2 x 3\n"));
  CHECK(json_of({files.a, files.folder / "small.exr"}, 6)["mismatch"] == "different sizes: 4 x 3 and 2 x 3");
  write_exr(files.folder / "grey.exr", blank_picture(4, 3, {{"Y", Type::half}}));
  const RunResult channels = run_program({"compare", files.a, files.folder / "grey.exr"});
  CHECK(channels.code == 6);
  CHECK_THAT(channels.err, Catch::Contains("only in the first: G,R; only in the second: Y"));

  Picture nan_picture = blank_picture(1, 1, {{"Y", Type::float32}});
  set(nan_picture.channels[0], 0, std::numeric_limits<float>::quiet_NaN());
  write_exr(files.folder / "nan.exr", nan_picture);
  CHECK(run_program({"compare", files.folder / "nan.exr", files.folder / "nan.exr"}).code == 0);
  const RunResult nan =
      run_program({"compare", files.folder / "nan.exr", files.folder / "nan.exr", "--nan-fail"});
  CHECK(nan.code == 6);
  CHECK_THAT(nan.err, Catch::Contains("at most by inf"));
}

TEST_CASE("compare tells how far two level sets lie apart, in voxels") {
  const TemporaryFolder folder;
  write_text(folder / "box.obj", box_obj(3, 2, 1));
  write_text(folder / "other.obj", box_obj(3.05, 2, 1));
  const std::vector<std::string> voxels{"--voxel", "0.1", "-q"};
  for (const auto& [mesh, vdb] : {std::pair{"box.obj", "a.vdb"}, {"other.obj", "b.vdb"}}) {
    std::vector<std::string> arguments{"convert", folder / mesh, folder / vdb};
    arguments.insert(arguments.end(), voxels.begin(), voxels.end());
    REQUIRE(run_program(arguments).code == 0);
  }
  CHECK(run_program({"compare", folder / "a.vdb", folder / "a.vdb"}).code == 0);
  const Json json = json_of({folder / "a.vdb", folder / "b.vdb"}, 6);
  CHECK(json["type"] == "vdb");
  CHECK(json["unit"] == "voxels");
  // The side moved by half a voxel, so no distance changes by more; floats of 0.3 have 3e-8.
  CHECK(json["max_error"].get<double>() <= 0.5 + 1e-5);
  CHECK(json["max_error"].get<double>() > 0.49);
  CHECK(json["only_in_a"].get<int>() + json["only_in_b"].get<int>() > 0);
  CHECK(run_program({"compare", folder / "a.vdb", folder / "b.vdb", "--fail", "0.51"}).code == 0);

  REQUIRE(run_program({"convert", folder / "box.obj", folder / "c.vdb", "--voxel", "0.05", "-q"}).code == 0);
  const RunResult coarse = run_program({"compare", folder / "a.vdb", folder / "c.vdb"});
  CHECK(coarse.code == 6);
  CHECK_THAT(coarse.err,
             Catch::Contains("different transforms: voxel 0.1,") && Catch::Contains("voxel 0.05,"));
}

TEST_CASE("compare refuses what it cannot do before it reads") {
  const TwoPictures files;
  write_text(files.folder / "box.obj", box_obj(3, 2, 1));
  REQUIRE(run_program({"convert", files.folder / "box.obj", files.folder / "a.vdb", "--voxel", "0.1", "-q"})
              .code == 0);
  const std::string vdb = files.folder / "a.vdb";
  const auto names = files.folder.names();
  struct Row {
    std::vector<std::string> arguments;
    int code;
    std::string says;
  };
  const std::vector<Row> rows{
      {{files.a}, 2, "B"},
      {{files.a, vdb}, 2, "a .vdb cannot be compared with an .exr"},
      {{files.folder / "box.obj", vdb}, 2, "compare takes two .exr or two .vdb"},
      {{files.a, files.b, "--fail", "-1"}, 2, "must be a number >= 0, or inf"},
      {{files.a, files.b, "--fail", "nan"}, 2, "must be a number >= 0, or inf"},
      {{files.a, files.b, "--hardfial", "1"}, 2, "did you mean \"--hardfail\""},
      {{files.a, files.b, "--grid", "x"}, 2, "--grid"},
      {{files.a, files.b, "--diff", files.folder / "d.jpg"}, 2, ".exr, .png"},
      {{files.a, files.b, "--diff", files.b}, 2, "the output is the input"},
      {{vdb, vdb, "--diff", files.folder / "d.png"}, 2, "--diff"},
      {{vdb, vdb, "--nan-fail"}, 2, "--nan-fail"},
      {{files.a, files.folder / "none.exr"}, 3, "none.exr: no such file"},
      {{vdb, files.folder / "none.vdb"}, 3, "none.vdb: no such file"},
      {{vdb, vdb, "--grid", "density"}, 3, "density"},
      {{files.a, files.b, "--max-memory", "1MiB"}, 5, "--max-memory"},
      {{files.a, files.b, "--json", "/dev/full"}, 74, "/dev/full"},
      {{files.a, files.b, "--diff", "/proc/d.png"}, 74, "/proc/d.png"},
  };
  for (const Row& row : rows) {
    std::vector<std::string> arguments{"compare"};
    arguments.insert(arguments.end(), row.arguments.begin(), row.arguments.end());
    CAPTURE(arguments);
    const RunResult result = run_program(arguments);
    CHECK(result.code == row.code);
    CHECK_THAT(result.err, Catch::Contains(row.says));
    CHECK(std::count(result.err.begin(), result.err.end(), '\n') == 1);
    CHECK(files.folder.names() == names);
  }
}

TEST_CASE("every hostile EXR file ends in a refusal or a comparison, within 10 seconds and 1 GiB") {
  const std::filesystem::path folder = std::filesystem::path(LEVELRAY_TESTDATA) / "hostile-exr";
  if (!std::filesystem::is_directory(folder)) {
    WARN("skipped: no folder hostile-exr in " LEVELRAY_TESTDATA);
    return;
  }
  RunOptions limited;
#if !defined(__SANITIZE_ADDRESS__) &&                                                                        \
    !defined(__SANITIZE_THREAD__) // whose shadows need terabytes of addresses
  limited.in_child = [] {
    const rlimit memory{std::uint64_t{1} << 30, std::uint64_t{1} << 30};
    ::setrlimit(RLIMIT_AS, &memory);
  };
#endif
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string path = entry.path();
    CAPTURE(path);
    const auto start = std::chrono::steady_clock::now();
    const RunResult result = run_program({"compare", path, path}, limited);
    CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(10));
    CAPTURE(result.err);
    CHECK((result.code == 0 || result.code == 3 || result.code == 5));
    if (result.code != 0) {
      CHECK_THAT(result.err, Catch::StartsWith("levelray: " + path.substr(0, 100)));
      CHECK_THAT(result.err, !Catch::Contains("crashed")); // that would be a refusal, but not a clear one
      CHECK(std::count(result.err.begin(), result.err.end(), '\n') == 1);
    }
    ++files;
  }
  CHECK(files > 0);
}
