// What is wrong with a scene, and where: one line each, with the place, the key and a way out.
#include "levelray/core/error.hpp"
#include "levelray/io/scene_file.hpp"

#include "support/catch.hpp"

#include <fmt/format.h>
#include <string>

using namespace levelray;

namespace {

// A whole scene; each line of it is replaced in turn below.
const std::string good = R"({
  "levelray": 1,
  "camera": {"eye": [0, 1, 5], "target": [0, 0, 0]},
  "film": {"size": [64, 48], "samples": 4},
  "objects": [
    {"name": "ball", "mesh": "ball.obj", "material": {"kind": "glass", "ior": 1.5}},
    {"name": "cube", "level_set": "cube.####.vdb", "grid": "surface"}
  ],
  "lights": [{"kind": "directional", "direction": [1, 1, 1]}]
})";

std::string with(const std::string& old_text, const std::string& new_text) {
  std::string text = good;
  const std::size_t at = text.find(old_text);
  REQUIRE(at != std::string::npos);
  return text.replace(at, old_text.size(), new_text);
}

// The message of the refusal, or "" when there is none.
std::string refusal(const std::string& text, const std::vector<std::string>& overrides = {}) {
  try {
    parse_scene(text, "shot.json", overrides);
  } catch (const Error& error) {
    CHECK(error.kind() == ErrorKind::usage);
    CHECK(std::string(error.what()).size() <= Error::max_length);
    return error.what();
  }
  return "";
}

struct Bad {
  const char *old_text, *new_text, *message;
};

} // namespace

TEST_CASE("keys that a scene does not know are refused with the line and what was meant") {
  const Bad table[] = {
      {"\"camera\"", "\"camra\"", R"(shot.json:3: unknown key "camra"; did you mean "camera"?)"},
      {"\"eye\"", "\"eyes\"", R"(shot.json:3: unknown key "eyes" in camera; did you mean "eye"?)"},
      {"\"samples\"", "\"smaples\"",
       R"(shot.json:4: unknown key "smaples" in film; did you mean "samples"?)"},
      {"\"film\"", "\"Film\"", R"(shot.json:4: unknown key "Film"; did you mean "film"?)"},
      {"\"grid\"", "\"gird\"", R"(shot.json:7: unknown key "gird" in objects[1]; did you mean "grid"?)"},
      {"\"ior\"", "\"iro\"", R"(shot.json:6: unknown key "iro" in objects[0].material; did you mean "ior"?)"},
      {"\"kind\": \"directional\"", "\"knid\": \"directional\"",
       R"(shot.json:9: unknown key "knid" in lights[0]; did you mean "kind"?)"},
      {"\"samples\": 4", "\"exposure_time\": 4",
       R"(shot.json:4: unknown key "exposure_time" in film; keys here: size, samples, aov)"},
      {"\"glass\"", "\"diffuse\"", R"(shot.json:6: unknown key "ior" in objects[0].material; )"},
  };
  for (const Bad& bad : table) {
    INFO(bad.new_text);
    const std::string message = refusal(with(bad.old_text, bad.new_text));
    CHECK(message.substr(0, std::string(bad.message).size()) == bad.message);
  }
}

TEST_CASE("values of the wrong type, out of range and not among the names are refused with the line") {
  const Bad table[] = {
      {"4}", "\"4\"}", R"(shot.json:4: film.samples: must be a whole number from 1 to 1024, not "4")"},
      {"4}", "4.5}", "shot.json:4: film.samples: must be a whole number from 1 to 1024, not 4.5"},
      {"4}", "0}", "shot.json:4: film.samples: must be a whole number from 1 to 1024, not 0"},
      {"4}", "1e300}", "shot.json:4: film.samples: must be a whole number from 1 to 1024, not 1e+300"},
      {"4}", "true}", "shot.json:4: film.samples: must be a whole number from 1 to 1024, not true"},
      {"4}", "null}", "shot.json:4: film.samples: must be a whole number from 1 to 1024, not null"},
      {"4}", "[4]}", "shot.json:4: film.samples: must be a whole number from 1 to 1024, not a list"},
      {"4}", "5}", "shot.json:4: film.samples: must be a square number: 1, 4, 9, 16, 25, ... 1024"},
      {"[64, 48]", "[64]",
       "shot.json:4: film.size: must be a list of 2 whole numbers from 1 to 65536, not a list"},
      {"[64, 48]", "[64, 0]", "shot.json:4: film.size[1]: must be a whole number from 1 to 65536, not 0"},
      {"[64, 48]", "\"64x48\"",
       R"(shot.json:4: film.size: must be a list of 2 whole numbers from 1 to 65536, not "64x48")"},
      {"[0, 1, 5]", "[0, 1]", "shot.json:3: camera.eye: must be a list of 3 numbers, not a list"},
      {"[0, 1, 5]", "[0, \"1\", 5]", R"(shot.json:3: camera.eye[1]: must be a number, not "1")"},
      {"[0, 1, 5]", "[0, 1, 1e40]", "shot.json:3: camera.eye[2]: must be a number, not 1e+40"},
      {"[0, 1, 5]", "[0, 0, 0]", "shot.json:3: camera.target: is where the eye is; the camera looks nowhere"},
      {"\"glass\"", "\"glas\"",
       R"(shot.json:6: objects[0].material.kind: must be one of diffuse, phong, mirror, glass, not "glas"; did you mean "glass"?)"},
      {"1.5", "0.05", "shot.json:6: objects[0].material.ior: must be a number from 0.1 to 10, not 0.05"},
      {"\"levelray\": 1", "\"levelray\": 2", "shot.json:2: levelray: must be the number 1, not 2"},
      {"\"levelray\": 1", "\"levelray\": \"1\"", R"(shot.json:2: levelray: must be the number 1, not "1")"},
      {"[1, 1, 1]", "[0, 0, 0]", "shot.json:9: lights[0].direction: has no direction"},
      {"{\"size\": [64, 48], \"samples\": 4}", "[]", "shot.json:4: film: must be an object, not a list"},
      {"\"cube\"", "\"two words\"",
       R"(shot.json:7: objects[1].name: must be a name of letters, digits, _ and -, not "two words")"},
      {"\"cube\"", "\"ball\"", R"(shot.json:7: objects[1].name: "ball" is the name of objects[0] already)"},
      {"\"mesh\": \"ball.obj\"", "\"mesh\": \"ball.obj\", \"level_set\": \"b.vdb\"",
       "shot.json:6: objects[0]: only one of the keys level_set, mesh may be there"},
      {"\"mesh\": \"ball.obj\"", "\"id\": 3",
       "shot.json:6: objects[0]: one of the keys level_set, mesh is missing"},
      {"\"mesh\": \"ball.obj\"", "\"mesh\": \"\"", "shot.json:6: objects[0].mesh: must not be empty"},
      {"\"mesh\": \"ball.obj\"", "\"mesh\": \"ball.obj\", \"grid\": \"x\"",
       "shot.json:6: objects[0].grid: is for level_set, not for mesh"},
      {"\"mesh\": \"ball.obj\"", "\"mesh\": \"a\\u0000b\"",
       "shot.json:6: objects[0].mesh: too long, or holds a zero character"},
      {"\"mesh\": \"ball.obj\"", "\"mesh\": \"ball.obj\", \"convert\": {\"voxel\": \"3furlongs\"}",
       R"(shot.json:6: objects[0].convert.voxel: must be a length such as "2mm", "0.01" or "0.5%", not "3furlongs")"},
      {"\"target\": [0, 0, 0]", "\"target\": [0, 0, 0], \"keys\": [{\"frame\": 2}, {\"frame\": 2}]",
       "shot.json:3: camera.keys: the keys' frames must rise"},
      {"\"target\": [0, 0, 0]", "\"target\": [0, 0, 0], \"keys\": [{\"eye\": [1, 1, 1]}]",
       R"(shot.json:3: camera.keys[0]: the key "frame" is missing)"},
      {", \"target\": [0, 0, 0]", "", R"(shot.json:3: camera: the key "target" is missing)"},
      {"\"kind\": \"directional\", ", "",
       R"(shot.json:9: lights[0]: the key "kind" is missing; choose directional, point)"},
      {"{\"kind\": \"directional\", \"direction\": [1, 1, 1]}", "7",
       "shot.json:9: lights[0]: must be an object, not 7"},
  };
  for (const Bad& bad : table) {
    INFO(bad.new_text);
    CHECK(refusal(with(bad.old_text, bad.new_text)) == bad.message);
  }
}

TEST_CASE("what is no JSON is refused with line and column") {
  const Bad table[] = {
      {"\"samples\": 4}", "\"samples\": 4,}", "shot.json:4:43: not JSON: no comma before the closing }"},
      {"[64, 48]", "[64, 48,]", "shot.json:4:28: not JSON: no comma before the closing ]"},
      {"[64, 48]", "[64,, 48]", "shot.json:4:24: not JSON: a comma too many"},
      {"\"film\"", "// the picture\n\"film\"", "shot.json:4:3: not JSON: JSON has no comments"},
      {"\"film\"", "'film'", "shot.json:4:3: not JSON: texts and keys stand in double quotes"},
      {"\"samples\"", "samples", "shot.json:4:30: not JSON: unexpected \"samples\""},
      {"4}", "NaN}", "shot.json:4:41: not JSON: a number must be finite"},
      {"4}", "-Infinity}", "shot.json:4:41: not JSON: a number must be finite"},
      {"4}", "1e999}", "shot.json:4: a number is too large for a double"},
      {"4}", "True}", "shot.json:4:41: not JSON: write true and false in lower case"},
      {"4}", "+4}", "shot.json:4:41: not JSON: a number takes no plus sign"},
      {"4}", ".5}", "shot.json:4:41: not JSON: write 0 before the decimal point"},
      {"},\n  \"objects\"", "}\n  \"objects\"", "shot.json:5:3: not JSON: a comma is missing before it"},
      {"\"surface\"", "\"surf\xff\"", "shot.json:7:65: not UTF-8 text: unexpected \"?\"}\n"},
      {"\"surface\"", "\"surf\nace\"",
       "shot.json:7:65: a text holds a line break or control character; is a quote missing?"},
      {"\"film\"", "\"camera\"", R"(shot.json:4: key "camera" occurs twice in this object)"},
  };
  for (const Bad& bad : table) {
    INFO(bad.new_text);
    const std::string message = refusal(with(bad.old_text, bad.new_text));
    const std::string expected = printable(bad.message, 480);
    CHECK(message.substr(0, expected.find("unexpected \"?\"")) ==
          expected.substr(0, expected.find("unexpected \"?\"")));
  }
  CHECK(refusal("") == "shot.json:1:1: not JSON: the text ends too early; a bracket or quote is not closed");
  CHECK(refusal(good.substr(0, 100)).find("the text ends too early") != std::string::npos);
  CHECK(refusal("[]") == "shot.json:1: a scene is an object in braces, not a list");
  CHECK(refusal("3") == "shot.json:1: a scene is an object in braces, not a number");
  CHECK(refusal(good + "\n}") == "shot.json:11:1: not JSON: unexpected \"}\"");
  CHECK(refusal(good + std::string(1, '\0')) ==
        fmt::format("shot.json@{}: holds a zero byte; JSON is plain UTF-8 text", good.size()));
  CHECK(refusal("\xEF\xBB\xBF" + good).empty()); // a byte order mark
}

TEST_CASE("scenes that are bombs are refused before they take memory") {
  const std::string deep = std::string(100000, '[') + std::string(100000, ']');
  CHECK(refusal(deep) == "shot.json:1: lists and objects nest more than 32 deep");
  std::string deeper = with("\"surface\"", deep);
  CHECK(refusal(deeper) == "shot.json:7: lists and objects nest more than 32 deep");
  std::string many = "[0";
  for (std::size_t i = 0; i < max_json_values; ++i) many += ",0";
  CHECK(refusal(many + "]") == "shot.json:1: more than 1000000 values");
  CHECK(refusal(std::string(max_json_bytes + 1, ' ')) == "shot.json: larger than 16 MiB; is this a scene?");
  const std::string long_key(100000, 'k');
  CHECK(refusal(with("camera", long_key)).starts_with("shot.json:3: unknown key \"kkkk"));
  CHECK(refusal(with("surface", std::string(100000, 'x'))) ==
        "shot.json:7: objects[1].grid: too long, or holds a zero character");
  CHECK(refusal(with("\"glass\"", "\"" + std::string(100000, 'x') + "\"")).size() <= Error::max_length);
}

TEST_CASE("--set says what cannot be, in the option's words") {
  const auto set = [](const std::string& text) { return refusal(good, {text}); };
  CHECK(set("film.samples=9").empty());
  CHECK(set("film") == "--set film: not PATH=VALUE, e.g. film.samples=4");
  CHECK(set("=4") == "--set =4: not PATH=VALUE, e.g. film.samples=4");
  CHECK(set("film..samples=4") == "--set film..samples=4: the path has an empty step");
  CHECK(set("film.smaples=4") ==
        R"(--set film.smaples=4: unknown key "smaples" in film; did you mean "samples"?)");
  CHECK(set("flim.samples=4") == R"(--set flim.samples=4: unknown key "flim"; did you mean "film"?)");
  CHECK(set("film.samples=many") ==
        R"(--set film.samples=many: film.samples: must be a whole number from 1 to 1024, not "many")");
  CHECK(set("film.samples.x=1") ==
        R"(--set film.samples.x=1: "x" would be inside of a number, which holds no keys)");
  CHECK(set("objects.7.id=1") == "--set objects.7.id=1: there are 2 items, counted from 0; none is number 7");
  CHECK(set("objects.bal.id=1") ==
        R"(--set objects.bal.id=1: nothing there is named "bal"; did you mean "ball"?)");
  CHECK(set("objects.-1.id=1") ==
        R"(--set objects.-1.id=1: nothing there is named "-1"; use a name or a number from 0)");
  CHECK(set("lights.0.direction=[0,0,0]") ==
        "--set lights.0.direction=[0,0,0]: lights[0].direction: has no direction");
  CHECK(set("camera=7") == "--set camera=7: camera: must be an object, not 7");
}
