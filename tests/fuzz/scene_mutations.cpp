// Damaged scene files, made from a whole one with every key: each must end in a scene that can be evaluated
// and written, or in an Error of one line.
#include "levelray/core/error.hpp"
#include "levelray/io/scene_frame.hpp"

#include "support/catch.hpp"

#include <chrono>
#include <fstream>
#include <iterator>
#include <random>

using namespace levelray;

namespace {

constexpr std::uint64_t seed = 20261123;
constexpr int mutants = 10000;

using Random = std::mt19937_64;

std::size_t below(Random& random, std::size_t n) {
  return n == 0 ? 0 : static_cast<std::size_t>(random() % n);
}

const char* const pieces[] = {"{",
                              "}",
                              "[",
                              "]",
                              ",",
                              ":",
                              "\"",
                              "null",
                              "true",
                              "-1",
                              "0",
                              "1e308",
                              "-1e308",
                              "1e999",
                              "1e-320",
                              "NaN",
                              "4294967296",
                              "0.5",
                              "\"\"",
                              "\"\\u0000\"",
                              "\"\\ud800\"",
                              "\"glass\"",
                              "\"smooth\"",
                              "[0,0,0]",
                              "[1e12,1e12,-1e12]",
                              "{}",
                              "\"kind\":\"mirror\"",
                              "//",
                              "\xff",
                              "\xEF\xBB\xBF",
                              "\n",
                              "\t",
                              "\"frame\": 2",
                              "\"keys\": []",
                              "\"a.####.vdb\"",
                              "99999999999999999999999999",
                              "-0",
                              "\\",
                              "\x01"};

// A copy with one to six small changes: bytes, pieces, lines moved, copied, cut out.
std::string mutant(const std::string& whole, Random& random) {
  std::string text = whole;
  for (std::size_t i = 0, n = 1 + below(random, 6); i < n; ++i) {
    const std::size_t at = below(random, text.size() + 1), length = below(random, 40);
    switch (random() % 7) {
    case 0:
      if (at < text.size()) text[at] = static_cast<char>(random());
      break;
    case 1:
      text.insert(at, pieces[below(random, std::size(pieces))]);
      break;
    case 2:
      if (at < text.size()) text.erase(at, length);
      break;
    case 3:
      if (at < text.size()) text.insert(below(random, text.size()), text.substr(at, length));
      break;
    case 4: { // another value after a colon
      const std::size_t colon = text.find(": ", at);
      if (colon != std::string::npos) {
        const std::size_t end = text.find_first_of(",}\n", colon + 2);
        if (end != std::string::npos)
          text.replace(colon + 2, end - colon - 2, pieces[below(random, std::size(pieces))]);
      }
      break;
    }
    case 5: { // another number
      const std::size_t digit = text.find_first_of("0123456789", at);
      if (digit != std::string::npos) text.replace(digit, 1, pieces[8 + below(random, 10)]);
      break;
    }
    default:
      if (random() % 20 == 0) text.resize(at);
    }
  }
  return text;
}

// Whether the scene was taken; everything that is done with scenes before rendering is done.
bool try_scene(const std::string& text, const std::vector<std::string>& overrides) {
  try {
    const SceneFile scene = parse_scene(text, "shot.json", overrides);
    const SceneInputs inputs = scene_inputs(scene);
    const std::vector<BlockGrid> grids(inputs.files.size());
    std::vector<const BlockGrid*> pointers;
    for (const BlockGrid& grid : grids) pointers.push_back(&grid);
    for (const double frame : {-1e9, 0.0, 1.0, 2.5, 1e9}) {
      frame_text(scene, inputs, frame);
      const Scene made = scene_at(scene, inputs, frame, pointers);
      check_scene(made);
      render_options_at(scene, frame);
    }
    for (const JsonValue& json : {full_scene_json(scene), short_scene_json(scene)})
      CHECK(full_scene_json(parse_scene(json_text(json), "shot.json")) == full_scene_json(scene));
    return true;
  } catch (const Error& error) {
    const std::string what = error.what();
    CHECK(error.kind() == ErrorKind::usage);
    CHECK(what.size() <= Error::max_length);
    CHECK(what.find('\n') == std::string::npos);
    return false;
  }
}

} // namespace

TEST_CASE("damaged scenes end in a scene or in one line") {
  CAPTURE(seed);
  Random random(seed);
  std::ifstream file(LEVELRAY_SOURCE_DIR "/data/scenes/still_life.json");
  const std::string still_life{std::istreambuf_iterator<char>(file), {}};
  std::ifstream other_file(LEVELRAY_SOURCE_DIR "/data/scenes/turn.json");
  const std::string turn{std::istreambuf_iterator<char>(other_file), {}};
  REQUIRE(try_scene(still_life, {}));
  REQUIRE(try_scene(turn, {}));
  int taken = 0;
  double slowest = 0;
  for (int i = 0; i < mutants; ++i) {
    const std::string text = mutant(i % 2 ? still_life : turn, random);
    CAPTURE(i, text);
    const auto start = std::chrono::steady_clock::now();
    taken += try_scene(text, {});
    slowest =
        std::max(slowest, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  CAPTURE(taken, slowest);
  CHECK(taken > mutants / 100); // some changes are harmless, most are not
  CHECK(taken < mutants / 2);
  CHECK(slowest < 5); // milliseconds, and room for a machine that is busy
}

TEST_CASE("damaged --set options end in a scene or in one line") {
  CAPTURE(seed);
  Random random(seed + 1);
  std::ifstream file(LEVELRAY_SOURCE_DIR "/data/scenes/turn.json");
  const std::string turn{std::istreambuf_iterator<char>(file), {}};
  const std::string whole[] = {"film.samples=4", "objects.ball.material={\"kind\": \"glass\", \"ior\": 1.4}",
                               "objects.1.transform.keys.0.translate=[1, 2, 3]",
                               "camera.keys=[{\"frame\": 1, \"eye\": [0, 1, 2]}]", "lights.0.intensity=2"};
  for (int i = 0; i < 2000; ++i) {
    const std::string text = mutant(whole[below(random, std::size(whole))], random);
    CAPTURE(i, text);
    try_scene(turn, {text});
  }
}
