#include "levelray/core/error.hpp"
#include "levelray/io/scene_file.hpp"
#include "scene_frames.hpp"
#include "support/catch.hpp"
#include "support/mesh_files.hpp"
#include "support/read_exr.hpp"
#include "support/read_output.hpp"
#include "support/run_program.hpp"
#include "support/temporary_folder.hpp"

#include <filesystem>
#include <fstream>

using namespace levelray::test;

namespace {

namespace fs = std::filesystem;

RunResult run(std::vector<std::string> arguments, const std::vector<std::string>& more = {}) {
  arguments.insert(arguments.end(), more.begin(), more.end());
  RunResult result = run_program(arguments);
  INFO(result.err);
  CHECK(!result.signalled);
  return result;
}

// A scene of two balls and a mirror between lights; "A" stands for more keys of the first ball.
std::string scene_text(const std::string& more = "") {
  return R"({
  "levelray": 1,
  "camera": {"eye": [0, 1, 7], "target": [0, 0, 0], "keys": [{"frame": 1, "fov": 40}, {"frame": 3, "fov": 30}]},
  "film": {"size": [60, 40]},
  "objects": [
    {"name": "ball", "mesh": "ball.obj", "convert": {"resolution": 20}, "material": {"kind": "diffuse"})" +
         more + R"(},
    {"name": "twin", "mesh": "ball.obj", "convert": {"resolution": 20}, "transform": {"translate": [2.2, 0, 0]},
     "material": {"kind": "mirror"}},
    {"name": "small", "mesh": "ball.obj", "convert": {"resolution": 20},
     "transform": {"scale": 0.5, "keys": [{"frame": 1, "translate": [-2, 0, 0]}, {"frame": 3, "translate": [-2, 1, 0]}]},
     "material": {"kind": "phong", "albedo": [0.1, 0.2, 0.9]}}
  ],
  "lights": [{"kind": "directional", "direction": [1, 1, 1]}],
  "sky": {"radiance": [0.2, 0.2, 0.3]},
  "outputs": ["out.####.exr"]
})";
}

} // namespace

TEST_CASE("a scene that was started from an input renders the same bytes as the input itself") {
  const TemporaryFolder folder;
  write_text(folder / "ball.obj", ball_obj(20));
  REQUIRE(run({"convert", folder / "ball.obj", folder / "ball.vdb", "--resolution", "40", "-q"}).code == 0);
  fs::create_directory(folder / "scenes");
  const std::vector<std::vector<std::string>> looks = {
      {"--resolution", "30", "--size", "70x50"},
      {"--resolution", "30", "--size", "50x70", "--shadows", "--ground", "--samples", "4", "--aov", "all"},
      {"--resolution", "30", "--size", "40x40", "--up", "0,0,1", "--shading", "lambert", "--light",
       "1,2,3,0.7", "--intersector", "midpoint", "--normals", "difference-of-interpolations", "--shadows"},
      {"--resolution", "30", "--size", "40x40", "--eye", "0.1,0.2,4", "--fov", "33", "--sign", "winding"}};
  for (const std::string input : {"ball.obj", "ball.vdb"})
    for (std::vector<std::string> look : looks) {
      if (input == "ball.vdb") {
        look.erase(look.begin(), look.begin() + 2);
        if (look.back() == "winding") look.resize(look.size() - 2);
      }
      INFO(input << " " << look[3]);
      const RunResult direct =
          run({"render", folder / input, "-o", folder / "a.exr", "-o", folder / "a.png"}, look);
      CHECK(direct.code == 0);
      const RunResult init = run({"scene", "init", folder / input, "-o", folder / "scenes/shot.json"}, look);
      INFO(init.err);
      CHECK(init.code == 0);
      const RunResult scene =
          run({"render", folder / "scenes/shot.json", "-o", folder / "b.exr", "-o", folder / "b.png"});
      INFO(scene.err);
      CHECK(scene.code == 0);
      CHECK(content_of(folder / "a.exr").size() > 1000);
      CHECK(content_of(folder / "a.exr") == content_of(folder / "b.exr"));
      CHECK(content_of(folder / "a.png") == content_of(folder / "b.png"));
    }
}

TEST_CASE("a scene's objects, ids and animation reach the picture") {
  const TemporaryFolder folder;
  write_text(folder / "ball.obj", ball_obj(20));
  write_text(folder / "shot.json", scene_text());
  const RunResult result = run({"render", folder / "shot.json", "-f", "1-4", "--aov", "id,Z", "--json", "-"});
  INFO(result.err);
  REQUIRE(result.code == 0);
  // Beside the scene, as its key "outputs" has it.
  const ExrImage first = read_exr(folder / "out.0001.exr"), last = read_exr(folder / "out.0003.exr");
  CHECK(first.width == 60);
  for (const float id : {0.0f, 1.0f, 2.0f, 3.0f})
    CHECK(std::count(first.at("id").begin(), first.at("id").end(), id) > 20);
  CHECK(first.at("id") != last.at("id"));
  CHECK(read_exr(folder / "out.0004.exr").channels == last.channels); // at rest after the last key
  std::istringstream lines(result.out);
  std::string line;
  REQUIRE(std::getline(lines, line));
  const Json json = Json::parse(line);
  CHECK(json["status"] == "rendered");
  CHECK(json["rays"]["primary"] == 60 * 40);
  CHECK(json["rays"]["secondary"] > 100); // of the mirror
  CHECK(json["input"].size() == 1);       // three objects share one file
}

TEST_CASE("options and --set change a scene's film, and what the scene says itself is refused as an option") {
  const TemporaryFolder folder;
  write_text(folder / "ball.obj", ball_obj(20));
  write_text(folder / "shot.json", scene_text());
  const std::vector<std::string> render{"render", folder / "shot.json", "-o", folder / "a.exr"};
  CHECK(run(render, {"--size", "20x10"}).code == 0);
  CHECK(read_exr(folder / "a.exr").width == 20);
  CHECK(run(render, {"--set", "film.size=[30,20]", "--set", "film.aov=[\"t\"]"}).code == 0);
  CHECK(read_exr(folder / "a.exr").width == 30);
  CHECK(read_exr(folder / "a.exr").channels.count("t") == 1);
  CHECK(run(render, {"--set", "film.size=[30,20]", "--size", "12x10"}).code == 0); // options come last
  CHECK(read_exr(folder / "a.exr").width == 12);
  const std::string before = content_of(folder / "a.exr");
  CHECK(run(render, {"--size", "12x10", "--set", "objects.ball.material.albedo=[1,0,0]"}).code == 0);
  CHECK(content_of(folder / "a.exr") != before);

  const std::pair<std::string, std::string> foreign[] = {{"--eye=1,2,3", "camera.eye"},
                                                         {"--fov=20", "camera.fov"},
                                                         {"--light=1,1,1", "lights"},
                                                         {"--shadows", "lights.0.shadows"},
                                                         {"--ground", "ground"},
                                                         {"--shading=lambert", "objects.0.material.kind"},
                                                         {"--resolution=9", "objects.0.convert.resolution"},
                                                         {"--grid=a", "objects.0.grid"}};
  for (const auto& [option, key] : foreign) {
    const RunResult result = run(render, {option});
    CHECK(result.code == 2);
    CHECK(result.err == "levelray: " + option.substr(0, option.find('=')) +
                            " is not for scenes, which have their own: --set " + key + "=...\n");
  }
  const RunResult typo = run(render, {"--set", "film.smaples=4"});
  CHECK(typo.code == 2);
  CHECK(typo.err ==
        "levelray: --set film.smaples=4: unknown key \"smaples\" in film; did you mean \"samples\"?\n");
  const RunResult no_scene =
      run({"render", folder / "ball.obj", "-o", folder / "a.exr", "--set", "film.samples=4"});
  CHECK(no_scene.code == 2);
}

TEST_CASE("what is wrong with a scene is one line, with the exit code of its kind") {
  const TemporaryFolder folder;
  write_text(folder / "ball.obj", ball_obj(8));
  const auto render = [&](const std::string& text) {
    write_text(folder / "shot.json", text);
    const RunResult result = run({"render", folder / "shot.json", "-o", folder / "a.exr"});
    CHECK(std::count(result.err.begin(), result.err.end(), '\n') == 1);
    CHECK(!fs::exists(folder / "a.exr"));
    return result;
  };
  const std::string place = "levelray: " + (folder / "shot.json");
  std::string text = scene_text();
  CHECK(render(text.replace(text.find("\"camera\""), 8, "\"camra\"")).err ==
        place + ":3: unknown key \"camra\"; did you mean \"camera\"?\n");
  CHECK(render(text).code == 2);
  RunResult result = render(scene_text(R"(, "transform": {"scale": 0})"));
  CHECK(result.code == 2);
  CHECK(result.err.find(":6: objects[0].transform.scale: must be a number from 1e-06") != std::string::npos);
  text = scene_text();
  result = render(text.replace(text.find("ball.obj"), 8, "gone.obj"));
  CHECK(result.code == 3);
  CHECK(result.err.find("gone.obj: no such file") != std::string::npos);
  text = scene_text();
  const std::string mesh = "\"mesh\": \"ball.obj\", \"convert\": {\"resolution\": 20}";
  result = render(text.replace(text.find(mesh), mesh.size(), "\"level_set\": \"ball.obj\""));
  CHECK(result.code == 2);
  CHECK(result.err.find("is no .vdb; use the key \"mesh\"") != std::string::npos);
  text = scene_text();
  result = render(text.replace(text.find("\"resolution\": 20"), 16, "\"voxel\": \"2mm\""));
  CHECK(result.code == 2);
  CHECK(result.err.find(":6: --voxel: the input's unit is not known") != std::string::npos);
  text = scene_text();
  result = render(text.replace(text.find("[0, 1, 7]"), 9, "[0, 9, 0]"));
  CHECK(result.code == 2);
  CHECK(result.err.find(":3: frame 1: the camera's up is parallel to its view") != std::string::npos);
  CHECK(run({"render", folder / "none.json", "-o", folder / "a.exr"}).code == 3);
  write_text(folder / "shot.json", scene_text());
  CHECK(run({"render", folder / "shot.json"}).code == 2); // out.####.exr, and no frames
  CHECK(run({"render", folder / "shot.json", "-o", folder / "shot.json"}).code == 2);
  CHECK(run({"scene", "init", folder / "ball.obj", "-o", folder / "shot.txt"}).code == 2);
  CHECK(run({"scene", "init", folder / "ball.obj"}).code == 2);
  CHECK(run({"scene", "begin", folder / "ball.obj"}).code == 2);
  CHECK(run({"scene", "check", folder / "shot.json"}).code == 0);
  CHECK(run({"scene", "check", folder / "ball.obj"}).code == 2);
}

TEST_CASE("scenes skip frames that are there, and make those again whose scene or files changed") {
  const TemporaryFolder folder;
  write_text(folder / "ball.obj", ball_obj(16));
  for (int frame = 1; frame <= 3; ++frame)
    write_text(folder / ("wave.000" + std::to_string(frame) + ".obj"), ball_obj(10 + frame));
  std::string text = scene_text();
  text.replace(text.find("ball.obj"), 8, "wave.####.obj");
  write_text(folder / "shot.json", text);
  const auto statuses = [&](const std::vector<std::string>& more) {
    const RunResult result =
        run({"render", folder / "shot.json", "-f", "1-3", "--skip-existing", "--json", "-"}, more);
    INFO(result.err);
    CHECK(result.code == 0);
    std::string all;
    std::istringstream lines(result.out);
    for (std::string line; std::getline(lines, line);)
      if (const Json json = Json::parse(line); json.contains("status"))
        all += json["status"].get<std::string>()[0];
    return all;
  };
  CHECK(statuses({}) == "rrr");
  const std::string second = content_of(folder / "out.0002.exr");
  CHECK(statuses({}) == "sss");
  CHECK(statuses({"--set", "fps=30"}) == "sss");
  write_text(folder / "wave.0002.obj", ball_obj(20));
  CHECK(statuses({}) == "srs");
  CHECK(content_of(folder / "out.0002.exr") != second);
  write_text(folder / "wave.0002.obj", ball_obj(12));
  CHECK(statuses({}) == "srs");
  CHECK(content_of(folder / "out.0002.exr") == second);
  CHECK(statuses({"--set", "camera.keys.1.fov=35"}) == "srr"); // frame 1 has the first key's
}

TEST_CASE("a scene's file for which no memory is left is refused, not loaded without a limit") {
  const TemporaryFolder folder;
  write_text(folder / "ball.obj", ball_obj(20));
  write_text(folder / "shot.json", scene_text());
  const levelray::SceneFile scene = levelray::read_scene(folder / "shot.json");
  const levelray::InputOptions input;
  const levelray::PictureOptions picture;
  const levelray::SceneFrames frames(scene, input, picture);
  try {
    frames.load(frames.input_paths(), 0, 60);
    FAIL("the file was loaded");
  } catch (const levelray::Error& error) {
    CHECK(error.kind() == levelray::ErrorKind::limit);
    CHECK_THAT(error.what(), Catch::Contains("ball.obj"));
  }
  CHECK(frames.load(frames.input_paths(), std::uint64_t{1} << 40, 60)->bytes > 0);
}
