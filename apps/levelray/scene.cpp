// levelray scene: starts a scene file, or checks one.
#include "commands.hpp"
#include "framing.hpp"
#include "input.hpp"
#include "levelray/core/error.hpp"
#include "levelray/core/parallel.hpp"
#include "levelray/io/frame_list.hpp"
#include "levelray/io/frame_pattern.hpp"
#include "levelray/io/output_file.hpp"
#include "levelray/io/scene_frame.hpp"
#include "names.hpp"
#include "starting_scene.hpp"

#include <filesystem>
#include <fmt/format.h>
#include <memory>

namespace levelray {

namespace {

struct SceneCommand {
  CommonOptions common;
  InputOptions input;
  ConversionOptions conversion;
  PictureOptions picture;
  std::string action, output, frames;
  std::vector<std::string> files;

  void run();

 private:
  void init() const;
  void check() const;
};

void SceneCommand::run() {
  if (find_name("scene", action, {"init", "check"}) == 1) return check();
  if (files.size() > 1)
    throw Error(ErrorKind::usage, "scene init: takes one input, not " + std::to_string(files.size()));
  input.path = files.front();
  init();
}

void SceneCommand::init() const {
  if (output.empty()) throw Error(ErrorKind::usage, "scene init: --output is missing; e.g. -o shot.json");
  if (input.path == "-")
    throw Error(ErrorKind::usage, "scene init: a scene names its files; give one instead of standard input");
  picture.check();
  std::vector<std::string> outputs;
  check_output(output, input.path, {".json"}, outputs);
  const ThreadLimit threads(common.threads);
  Progress progress(common.quiet);
  InputOptions first = input;
  const FramePattern pattern(input.path);
  std::error_code ignored;
  if (frames.empty() && pattern.has_frame() && !std::filesystem::exists(input.path, ignored))
    throw Error(ErrorKind::usage,
                printable(input.path, 250) + ": a place for frames needs -f, e.g. -f 1-100");
  std::vector<int> numbers{0};
  if (!frames.empty()) numbers = framing_frames(parse_frames("--frames", frames));
  Framing seen(picture.resolve_without_grid().camera);
  LoadedGrid loaded;
  for (auto frame = numbers.rbegin(); frame != numbers.rend(); ++frame) { // the first one last, to stay
    if (!frames.empty()) first.path = pattern.path(*frame);
    loaded = {};
    loaded = load_grid(first, conversion, common, progress);
    seen.add(loaded.grid);
  }
  const RenderOptions options = picture.resolve(seen);
  const SceneFile scene = starting_scene(output, input, conversion, frames, loaded.grid, options);
  write_file_atomically(output, json_text(short_scene_json(scene)) + "\n");
  if (common.talks())
    print(fmt::format("wrote {0}: a scene of {1}; levelray render {0}\n", printable(output, 200),
                      printable(input.path, 200)));
  write_json(common, {{"scene", output}, {"input", input.path}, {"warnings", loaded.warnings}});
}

void SceneCommand::check() const {
  std::size_t bad = 0;
  Json list = Json::array();
  for (const std::string& path : files) try {
      const SceneFile scene = read_scene(path);
      if (common.talks())
        print(fmt::format("{}: {}, {}\n", printable(path, 300),
                          counted(scene.objects.size(), "object", "objects"),
                          counted(scene.lights.size(), "light", "lights")));
      std::vector<std::string> read;
      for (const SceneInput& file : scene_inputs(scene).files) read.push_back(file.path);
      list.push_back({{"scene", path},
                      {"objects", scene.objects.size()},
                      {"lights", scene.lights.size()},
                      {"files", read}});
    } catch (const Error& error) {
      if (files.size() == 1) throw;
      print_error(error.what());
      list.push_back({{"scene", path}, {"error", error.what()}});
      ++bad;
    }
  write_json(common, list);
  if (bad > 0) throw Error(ErrorKind::usage, fmt::format("{} of {} scenes are not right", bad, files.size()));
}

} // namespace

void add_scene(CLI::App& program, Work& run) {
  auto options = std::make_shared<SceneCommand>();
  CLI::App& command = *program.add_subcommand("scene", "Start a scene file, or check one");
  command.footer(R"(Examples:
  levelray scene init statue.vdb -o shot.json
  levelray scene init statue.ply -o shot.json --size 1920x1080 --shadows --ground
  levelray scene check shot.json other.json

Writes a scene (JSON) that shows what "levelray render" shows of the same input with the same options, camera and
lights written out, to be changed by hand; or tells whether scenes are right. "levelray render shot.json" renders
it.)");
  command.add_option("ACTION", options->action, "init or check")->required();
  command.add_option("IN", options->files, "init: a .vdb or a mesh; check: scenes")->required();
  command.add_option("--output,-o", options->output, "The .json to write")->type_name("FILE");
  command
      .add_option("--frames,-f", options->frames,
                  "Frames of an input with #### in its name; the camera goes by the first")
      ->type_name("LIST");
  options->picture.add_look_to(command);
  options->conversion.add_to(command);
  options->input.add_to(command);
  options->common.add_to(command);
  command.callback([options, &run] { run = [options] { options->run(); }; });
}

} // namespace levelray
