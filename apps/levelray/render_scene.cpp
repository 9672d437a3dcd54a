#include "render_scene.hpp"

#include "levelray/core/error.hpp"
#include "levelray/core/parallel.hpp"
#include "scene_frames.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace levelray {

namespace {

bool given(const CLI::App& command, const std::string& option) {
  const CLI::Option* found = command.get_option_no_throw(option);
  return found && found->count() > 0;
}

// Options of pictures of one input, and the keys that say it in a scene.
void refuse_foreign_options(const CLI::App& command) {
  constexpr struct {
    const char *option, *key;
  } foreign[] = {{"--eye", "camera.eye"},
                 {"--target", "camera.target"},
                 {"--up", "camera.up"},
                 {"--fov", "camera.fov"},
                 {"--turntable", "camera.keys"},
                 {"--camera-frames", "camera"},
                 {"--light", "lights"},
                 {"--shadows", "lights.0.shadows"},
                 {"--ground", "ground"},
                 {"--shading", "objects.0.material.kind"},
                 {"--grid", "objects.0.grid"},
                 {"--units", "objects.0.convert.units"},
                 {"--resolution", "objects.0.convert.resolution"},
                 {"--voxel", "objects.0.convert.voxel"},
                 {"--band", "objects.0.convert.band"},
                 {"--sign", "objects.0.convert.sign"},
                 {"--thicken", "objects.0.convert.thicken"},
                 {"--redistance", "objects.0.redistance"}};
  for (const auto& [option, key] : foreign)
    if (given(command, option))
      throw Error(ErrorKind::usage,
                  fmt::format("{} is not for scenes, which have their own: --set {}=...", option, key));
  for (const char* option : {"--format", "--repeat"})
    if (given(command, option)) throw Error(ErrorKind::usage, fmt::format("{} is not for scenes", option));
  // How grids are made is each object's own business, whatever options there are for it.
  for (const CLI::Option* option : command.get_options())
    if (option->get_group() == "Conversion" && option->count() > 0)
      throw Error(ErrorKind::usage, fmt::format("{} is not for scenes", option->get_name()));
}

// The film and the methods as options have them, where they were given.
void take_options(const CLI::App& command, const PictureOptions& picture, SceneFile& scene) {
  const RenderOptions options = picture.resolve_without_grid();
  if (given(command, "--size")) scene.film.size = {options.camera.width, options.camera.height};
  if (given(command, "--samples")) scene.film.samples = options.samples;
  if (given(command, "--aov")) scene.film.aov = options.aovs;
  if (given(command, "--intersector")) scene.render.intersector = options.intersector;
  if (given(command, "--normals")) scene.render.normals = options.normals;
  // The counter that --show needs is no AOV that somebody asked for twice.
  if (const std::string& show = picture.show;
      !show.empty() && std::count(scene.film.aov.begin(), scene.film.aov.end(), show) == 0)
    scene.film.aov.push_back(show);
}

// One picture, without a number.
void render_one(const SceneFrames& source, const FramePlan& plan, const CommonOptions& common,
                const InputOptions& input, const Json& options) {
  const Stopwatch total;
  Progress progress(common.quiet);
  const int frame = plan.frames.front();
  std::vector<std::string> paths;
  for (const FramePattern& pattern : plan.inputs) paths.push_back(pattern.text());
  const std::uint64_t limit = input.memory_limit(), making = source.making_bytes();
  const auto loaded = source.load(paths, limit - std::min(limit, making), input.read_timeout);
  const double load_ms = total.ms();
  if (const std::uint64_t needed = loaded->bytes + making; needed > limit)
    throw Error(ErrorKind::limit,
                fmt::format("rendering needs {}, --max-memory is {}", bytes_text(needed), bytes_text(limit)));
  progress.begin("render", 0, "");
  std::vector<std::string> outputs;
  for (const FramePattern& pattern : plan.outputs) outputs.push_back(pattern.text());
  MadeFrame made = source.make(frame, loaded, outputs, [&](double done) { progress.report(done); });
  progress.finish();
  std::vector<std::string> warnings = loaded->warnings;
  warnings.insert(warnings.end(), made.warnings.begin(), made.warnings.end());
  for (const std::string& warning : warnings) print_warning(warning);
  const Stopwatch write;
  made.write("");
  made.facts["ms"]["load"] = load_ms;
  made.facts["ms"]["write"] = write.ms();
  made.facts["ms"]["total"] = total.ms();
  if (common.talks())
    print(fmt::format("wrote {}: {} hits, total {}\n", fmt::join(outputs, ", "),
                      made.facts["hits"].get<std::uint64_t>(), duration_text(total.ms() / 1000)));
  made.facts["options"] = options;
  made.facts["warnings"] = warnings;
  write_json(common, made.facts);
}

} // namespace

void render_scene(const CLI::App& command, const std::vector<std::string>& overrides,
                  const CommonOptions& common, const InputOptions& input_options,
                  const PictureOptions& picture, const RenderFramesOptions& frame_options) {
  refuse_foreign_options(command);
  SceneFile scene = read_scene(input_options.path, overrides);
  take_options(command, picture, scene);
  check_scene_file(scene);

  InputOptions input = input_options;
  if (scene.limits.memory && !given(command, "--max-memory")) input.max_memory = *scene.limits.memory;
  RenderFramesOptions frames = frame_options;
  if (scene.frames && !given(command, "--frames")) frames.sequence.frames = *scene.frames;
  if (scene.limits.frame_seconds && !given(command, "--frame-timeout"))
    frames.sequence.frame_timeout = *scene.limits.frame_seconds;
  if (!given(command, "--fps")) frames.fps = scene.fps;
  std::vector<std::string> outputs = picture.outputs;
  if (outputs.empty())
    for (const std::string& output : scene.outputs) outputs.push_back(beside_scene(scene, output));
  if (outputs.empty())
    throw Error(ErrorKind::usage,
                scene.place + ": nothing says where the picture goes; add -o, or the key \"outputs\"");

  const SceneFrames source(scene, input, picture);
  const FramePlan plan = frames.plan(source.input_paths(), outputs);
  std::vector<std::string> written = plan.output_paths(plan.frames.front());
  for (const std::string& output : written) {
    std::vector<std::string> others;
    check_output(output, input.path, {}, others); // not the scene itself
  }
  if (!common.json.empty() && common.json != "-") check_output(common.json, input.path, {}, written);

  const ThreadLimit threads(common.threads);
  Json options = input.json();
  options.update(frames.json());
  options["output"] = outputs;
  options["show"] = picture.show;
  options.update(picture.acceleration.json());
  options["threads"] = thread_count();
  options["set"] = overrides;
  if (!frames.many(plan)) return render_one(source, plan, common, input, options);
  Sequence sequence(plan, frames.sequence, input.memory_limit());
  SequenceReport report(common, source.verb(), plan.frames.size());
  render_source(source, sequence, report, frames, {{"options", options}});
}

} // namespace levelray
