#include "support/catch.hpp"
#include "support/mesh_files.hpp"
#include "support/read_exr.hpp"
#include "support/read_output.hpp"
#include "support/run_program.hpp"
#include "support/temporary_folder.hpp"

#include <fstream>
#include <set>

using namespace levelray::test;

TEST_CASE("render's JSON has the documented keys, and times of repetitions as median, min and max") {
  const TemporaryFolder folder;
  write_text(folder / "ball.obj", ball_obj(20));
  const std::vector<std::string> arguments{"render",
                                           folder / "ball.obj",
                                           "-o",
                                           folder / "ball.exr",
                                           "--resolution",
                                           "40",
                                           "--size",
                                           "64x48",
                                           "--shadows",
                                           "--json",
                                           "-"};
  RunResult result = run_program(arguments);
  INFO(result.err);
  REQUIRE(result.code == 0);
  Json json = Json::parse(result.out);
  CHECK(keys(json) == std::set<std::string>{"grid", "options", "rays", "hits", "counts", "ms", "warnings"});
  CHECK(keys(json["grid"]) ==
        std::set<std::string>{"voxel_size", "dims", "blocks", "active_samples", "bytes"});
  CHECK(keys(json["rays"]) == std::set<std::string>{"primary", "shadow"});
  CHECK(keys(json["ms"]) == std::set<std::string>{"load", "prepare", "trace", "shade", "write", "total"});
  CHECK(keys(json["options"]) == std::set<std::string>{"size",
                                                       "eye",
                                                       "target",
                                                       "up",
                                                       "fov",
                                                       "intersector",
                                                       "normals",
                                                       "lights",
                                                       "shading",
                                                       "shadows",
                                                       "ground",
                                                       "samples",
                                                       "aov",
                                                       "repeat",
                                                       "threads",
                                                       "output",
                                                       "input",
                                                       "format",
                                                       "units",
                                                       "drop_bad",
                                                       "salvage",
                                                       "trust_orientation",
                                                       "strict",
                                                       "grid",
                                                       "trust_input",
                                                       "max_memory",
                                                       "resolution",
                                                       "band",
                                                       "sign",
                                                       "redistance",
                                                       "primary",
                                                       "minmax",
                                                       "traversal",
                                                       "shadow",
                                                       "occluder_steps",
                                                       "read_timeout",
                                                       "show"});
  for (const char* rays : {"primary", "shadow"})
    for (const char* count : {"steps", "tests", "interpolations", "samples"})
      CHECK(json["counts"][rays][count] > 0);
  CHECK(json["rays"]["primary"] == 64 * 48);
  CHECK(json["rays"]["shadow"] > 0);
  CHECK(json["hits"] > 64 * 48 / 10);
  CHECK(json["hits"] < 64 * 48);
  CHECK(json["ms"]["trace"].is_number());
  CHECK(json["options"]["lights"].size() == 3);

  std::vector<std::string> repeated = arguments;
  repeated.insert(repeated.end(), {"--repeat", "3"});
  result = run_program(repeated);
  REQUIRE(result.code == 0);
  json = Json::parse(result.out);
  for (const char* phase : {"prepare", "trace", "shade"}) {
    CHECK(keys(json["ms"][phase]) == std::set<std::string>{"median", "min", "max"});
    CHECK(json["ms"][phase]["min"] <= json["ms"][phase]["median"]);
    CHECK(json["ms"][phase]["median"] <= json["ms"][phase]["max"]);
  }
  CHECK(json["rays"]["primary"] == 64 * 48); // of one repetition
}

TEST_CASE("pictures have the same bytes for 1, 2 and 7 threads and any number of repetitions") {
  const TemporaryFolder folder;
  write_text(folder / "ball.obj", ball_obj(20));
  std::string exr, png;
  for (const char* threads : {"1", "2", "7"}) {
    const RunResult result = run_program({"render",       folder / "ball.obj",
                                          "-o",           folder / "a.exr",
                                          "-o",           folder / "a.png",
                                          "--resolution", "60",
                                          "--size",       "150x130",
                                          "--shadows",    "--ground",
                                          "--aov",        "all",
                                          "--samples",    "4",
                                          "--threads",    threads,
                                          "--repeat",     threads == std::string("2") ? "2" : "1"});
    INFO(result.err);
    REQUIRE(result.code == 0);
    if (exr.empty()) {
      exr = content_of(folder / "a.exr");
      png = content_of(folder / "a.png");
      CHECK(exr.size() > 10000);
      CHECK(png.size() > 1000);
    }
    CHECK(content_of(folder / "a.exr") == exr);
    CHECK(content_of(folder / "a.png") == png);
  }
}

TEST_CASE("a mesh and the level set made of it give the same picture") {
  const TemporaryFolder folder;
  write_text(folder / "ball.obj", ball_obj(20));
  REQUIRE(run_program({"convert", folder / "ball.obj", folder / "ball.vdb", "--resolution", "50"}).code == 0);
  REQUIRE(run_program({"render", folder / "ball.vdb", "-o", folder / "a.exr", "--size", "64x64"}).code == 0);
  REQUIRE(
      run_program({"render", folder / "ball.vdb", "-o", folder / "b.exr", "--size", "64x64", "--trust-input"})
          .code == 0);
  REQUIRE(run_program({"render", folder / "ball.obj", "-o", folder / "c.exr", "--size", "64x64",
                       "--resolution", "50"})
              .code == 0);
  CHECK(content_of(folder / "a.exr") == content_of(folder / "b.exr"));
  CHECK(content_of(folder / "a.exr") == content_of(folder / "c.exr"));
}

TEST_CASE("AOVs agree with each other, with the camera of the file, and with the ball they are of") {
  const TemporaryFolder folder;
  write_text(folder / "ball.obj", ball_obj(60));
  REQUIRE(run_program({"render", folder / "ball.obj", "-o", folder / "a.exr", "--resolution", "100", "--size",
                       "90x70", "--aov", "all", "--samples", "4", "--eye", "3,2,4", "--target", "0,0,0",
                       "--fov", "40"})
              .code == 0);
  const ExrImage image = read_exr(folder / "a.exr");
  REQUIRE(image.width == 90);
  REQUIRE(image.height == 70);
  CHECK(image.software.substr(0, 9) == "levelray ");
  const auto& [r, g, b, a] = std::tie(image.at("R"), image.at("G"), image.at("B"), image.at("A"));
  std::size_t hits = 0;
  for (std::size_t i = 0; i < r.size(); ++i) {
    const float z = image.at("Z")[i], t = image.at("t")[i];
    const Imath::V3d p(image.at("P.X")[i], image.at("P.Y")[i], image.at("P.Z")[i]);
    const Imath::V3d n(image.at("N.X")[i], image.at("N.Y")[i], image.at("N.Z")[i]);
    if (t == 1e30f) { // a miss of the pixel's centre
      CHECK(z == 1e30f);
      CHECK(p == Imath::V3d(0, 0, 0));
      CHECK(n == Imath::V3d(0, 0, 0));
      CHECK(a[i] < 1);
      if (a[i] == 0) CHECK((r[i] == 0 && g[i] == 0 && b[i] == 0));
      continue;
    }
    ++hits;
    // The point lies on the ball of radius 1: its 120 x 60 facets lie up to 1 - cos(pi/60) = 0.0014 inside,
    // and the interpolant of exact distances up to h^2/4 more, where h = 0.02.
    CHECK(std::abs(p.length() - 1) < 0.0016);
    CHECK(std::abs(n.length() - 1) < 1e-6);
    CHECK(n.dot(p.normalized()) > 0.99);
    CHECK(std::abs((p - Imath::V3d(3, 2, 4)).length() - t) < 1e-6); // float rounding of values near 5
    Imath::V3d ndc, camera;
    image.world_to_ndc.multVecMatrix(p, ndc);
    image.world_to_camera.multVecMatrix(p, camera);
    CHECK(std::abs(camera.z - z) < 1e-5);
    CHECK(std::abs(ndc.x * 90 - (static_cast<double>(i % 90) + 0.5)) < 0.01);
    CHECK(std::abs(ndc.y * 70 - (static_cast<double>(i / 90) + 0.5)) < 0.01);
    CHECK(image.at("tests")[i] >= 1);
    CHECK(image.at("steps")[i] >= image.at("tests")[i]);
  }
  CHECK(hits > 500);
}

TEST_CASE("automatic framing shows all of the object, upright, whichever axis is up") {
  const TemporaryFolder folder;
  // A block with a tower at one end of its top: seen from the front, the tower is in the upper half.
  for (const std::string up : {"0,1,0", "0,0,1"}) {
    const bool z_up = up == "0,0,1";
    write_text(folder / "tower.obj", z_up ? box_obj(1, 1, 4) : box_obj(1, 4, 1));
    REQUIRE(run_program({"render", folder / "tower.obj", "-o", folder / "a.exr", "--resolution", "60",
                         "--size", "80x100", "--up", up, "--aov", "P"})
                .code == 0);
    const ExrImage image = read_exr(folder / "a.exr");
    const auto& a = image.at("A");
    const auto& height = image.at(z_up ? "P.Z" : "P.Y");
    int top = 100, bottom = -1, covered = 0;
    for (int y = 0; y < 100; ++y)
      for (int x = 0; x < 80; ++x)
        if (a[static_cast<std::size_t>(y * 80 + x)] > 0) {
          CHECK((x > 0 && x < 79 && y > 0 && y < 99));
          top = std::min(top, y);
          bottom = std::max(bottom, y);
          ++covered;
        }
    CHECK(bottom - top > 70); // of 95 usable rows
    CHECK(covered > 1000);
    const auto highest = std::max_element(height.begin(), height.end()) - height.begin();
    CHECK(highest / 80 < 50);
  }
}

TEST_CASE("with a ground plane the object casts its shadow and the background stays transparent") {
  const TemporaryFolder folder;
  write_text(folder / "ball.obj", ball_obj(20));
  const auto render = [&](std::vector<std::string> more) {
    more.insert(more.begin(),
                {"render", folder / "ball.obj", "-o", folder / "a.exr", "--resolution", "50", "--size",
                 "100x100", "--light", "0,1,0", "--eye", "0,3,6", "--target", "0,0,0"});
    REQUIRE(run_program(more).code == 0);
    return read_exr(folder / "a.exr");
  };
  const ExrImage lit = render({"--ground"}), shadowed = render({"--ground", "--shadows"}), bare = render({});
  // The light comes from straight above: the point (0.7, -1, 0) lies in the ball's shadow, (2, -1, 0) does
  // not.
  const auto pixel = [&](double x, double y, double z) {
    Imath::V3d ndc;
    lit.world_to_ndc.multVecMatrix(Imath::V3d(x, y, z), ndc);
    return static_cast<std::size_t>(ndc.y * 100) * 100 + static_cast<std::size_t>(ndc.x * 100);
  };
  const std::size_t in_shadow = pixel(0.8, -1, 0.3), in_light = pixel(2, -1, 0);
  CHECK(lit.at("A")[in_shadow] == 1);
  CHECK(shadowed.at("R")[in_shadow] < 0.2 * lit.at("R")[in_shadow]);
  CHECK(shadowed.at("R")[in_light] == lit.at("R")[in_light]);
  CHECK(bare.at("A")[in_light] == 0);
  CHECK(lit.at("A")[50] == 0); // above the horizon
}

TEST_CASE("a camera inside the object sees its walls lit") {
  const TemporaryFolder folder;
  write_text(folder / "ball.obj", ball_obj(20));
  REQUIRE(run_program({"render", folder / "ball.obj", "-o", folder / "a.exr", "--resolution", "50", "--size",
                       "40x40", "--eye", "0,0,0.3", "--target", "0,0,0", "--aov", "N"})
              .code == 0);
  const ExrImage image = read_exr(folder / "a.exr");
  for (const float alpha : image.at("A")) CHECK(alpha == 1);
  CHECK(image.at("R")[20 * 40 + 20] > 0.2);
  CHECK(image.at("N.Z")[20 * 40 + 20] < -0.9); // outward, away from the eye
}

TEST_CASE("a camera that sees nothing says so") {
  const TemporaryFolder folder;
  write_text(folder / "ball.obj", ball_obj(10));
  const RunResult result = run_program({"render", folder / "ball.obj", "-o", folder / "a.png", "--resolution",
                                        "30", "--size", "20x20", "--eye", "0,0,9", "--target", "0,0,10"});
  CHECK(result.code == 0);
  CHECK_THAT(result.err, Catch::Contains("no ray met the surface"));
}

TEST_CASE("options that have no effect are warned of") {
  const TemporaryFolder folder;
  const std::string mesh = folder / "ball.obj", vdb = folder / "ball.vdb", png = folder / "ball.png";
  write_text(mesh, ball_obj(20));
  REQUIRE(run_program({"convert", mesh, vdb, "--resolution", "30"}).code == 0);
  const std::vector<std::string> small{"-o", png, "--size", "16x16"};
  const auto warning_of = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), small.begin(), small.end());
    const RunResult result = run_program(arguments);
    CHECK(result.code == 0);
    return result.err;
  };
  CHECK(warning_of({"render", vdb}).empty());
  CHECK_THAT(warning_of({"render", vdb, "--resolution", "60"}), Catch::Contains("no effect on a .vdb"));
  CHECK_THAT(warning_of({"render", vdb, "--sign", "flood"}), Catch::Contains("no effect on a .vdb"));
  CHECK_THAT(warning_of({"render", vdb, "--aov", "t"}), Catch::Contains("--aov is for .exr"));
  CHECK_THAT(warning_of({"render", mesh, "--resolution", "30", "--grid", "surface"}),
             Catch::Contains("no effect on a mesh"));
}

TEST_CASE("a picture beyond --max-memory is refused with 5") {
  const TemporaryFolder folder;
  write_text(folder / "ball.obj", ball_obj(10));
  const RunResult result = run_program({"render", folder / "ball.obj", "-o", folder / "a.png", "--resolution",
                                        "30", "--size", "60000x60000", "--max-memory", "1GB"});
  CHECK(result.code == 5);
  CHECK_THAT(result.err, Catch::Contains("--size 60000x60000"));
  CHECK(folder.names() == std::vector<std::string>{"ball.obj"});
}
