// levelray render: a mesh or a level set to a picture.
#include "commands.hpp"
#include "input.hpp"
#include "levelray/core/error.hpp"
#include "levelray/core/parallel.hpp"
#include "levelray/io/scene_file.hpp"
#include "picture_frames.hpp"
#include "render_frames.hpp"
#include "render_scene.hpp"
#include "tolerance.hpp"

#include <fmt/format.h>
#include <memory>

namespace levelray {

namespace {

struct Render {
  CommonOptions common;
  InputOptions input;
  ConversionOptions conversion;
  PictureOptions picture;
  RenderFramesOptions frames;
  ToleranceOption tolerance;
  std::vector<std::string> overrides;

  void run(const CLI::App& command) const;

 private:
  void run_one(const CLI::App& command) const;
};

// {median, min, max} of the repetitions, or their one value.
Json times_json(std::vector<double> ms) {
  if (ms.size() == 1) return ms.front();
  std::sort(ms.begin(), ms.end());
  const std::size_t n = ms.size();
  return {{"median", (ms[(n - 1) / 2] + ms[n / 2]) / 2}, {"min", ms.front()}, {"max", ms.back()}};
}

Json counts_json(const CountSums& sums) {
  return {{"steps", sums.steps},
          {"tests", sums.tests},
          {"interpolations", sums.interpolations},
          {"samples", sums.samples}};
}

double median(std::vector<double> ms) {
  std::sort(ms.begin(), ms.end());
  return (ms[(ms.size() - 1) / 2] + ms[ms.size() / 2]) / 2;
}

void Render::run(const CLI::App& command) const {
  if (is_scene(input.path) && tolerance.asked())
    throw Error(ErrorKind::usage, "--tolerance is for one mesh or .vdb, and this input is a scene");
  if (is_scene(input.path)) return render_scene(command, overrides, common, input, picture, frames);
  if (!overrides.empty()) throw Error(ErrorKind::usage, "--set is for scenes, and this input is none");
  if (picture.outputs.empty()) throw Error(ErrorKind::usage, "--output is required; e.g. -o picture.png");
  picture.check();
  const FramePlan plan = frames.plan({input.path}, picture.outputs);
  if (!frames.many(plan)) return run_one(command);
  if (tolerance.asked())
    throw Error(ErrorKind::usage,
                "--tolerance is for one picture; choose for one frame of the sequence, and give the "
                "others what it takes: --voxel, --intersector, --normals");
  render_frames(plan, common, input, conversion, picture, frames);
}

void Render::run_one(const CLI::App& command) const {
  std::vector<std::string> outputs;
  for (const std::string& output : picture.outputs)
    check_output(output, input.path, {".exr", ".png"}, outputs);
  if (!common.json.empty() && common.json != "-") check_output(common.json, input.path, {}, outputs);

  const ThreadLimit threads(common.threads);
  const Stopwatch total;
  Progress progress(common.quiet);
  std::optional<TolerableGrid> tolerable;
  if (tolerance.asked())
    tolerable = load_to_tolerance(tolerance, ToleranceLimits::of_render(command, picture), input, conversion,
                                  common, progress);
  const LoadedGrid loaded =
      tolerable ? std::move(tolerable->loaded) : load_grid(input, conversion, common, progress);
  const double load_ms = total.ms();

  RenderOptions options = picture.resolve(loaded.grid);
  if (tolerable)
    options.intersector = tolerable->chosen.intersector, options.normals = tolerable->chosen.normals;
  check_render_memory(picture, options, loaded.grid.bytes(), input.memory_limit());
  const double rays = static_cast<double>(options.camera.width) * options.camera.height * options.samples;
  progress.begin("render", rays * options.repeat, " rays");
  options.progress = [&](double done) { progress.report(done); };
  RenderedImage rendered = render_image(loaded.grid, options);
  progress.finish();
  const RenderStats& stats = rendered.stats;

  std::vector<std::string> warnings = loaded.warnings;
  const auto warn = [&](const char* text) {
    warnings.push_back(text);
    print_warning(text);
  };
  if (!picture.aovs.empty() &&
      std::none_of(picture.outputs.begin(), picture.outputs.end(),
                   [](const std::string& output) { return extension_of(output) == ".exr"; }))
    warn("--aov is for .exr files: a .png holds the picture only");
  if (stats.hits == 0)
    warn("no ray met the surface; look at --eye and --target, or leave them out to see all of it");

  const std::string legend = show_counter(picture, rendered.image);

  const Stopwatch write;
  const Camera camera(options.camera);
  for (const std::string& output : picture.outputs)
    write_picture(output, rendered.image, camera, "", {}, legend);
  const double write_ms = write.ms();

  if (common.talks() && !legend.empty()) print(legend.substr(1) + "\n");
  if (common.talks())
    print(fmt::format("wrote {}: {} x {}, {}, {}; trace {:.3g} ms, shade {:.3g} ms, total {}\n",
                      fmt::join(picture.outputs, ", "), options.camera.width, options.camera.height,
                      counted(stats.primary_rays + stats.shadow_rays, "ray", "rays"),
                      counted(stats.hits, "hit", "hits"), median(stats.trace_ms), median(stats.shade_ms),
                      duration_text(total.ms() / 1000)));
  Json all_options = picture.json(options, thread_count());
  all_options.update(input.json());
  all_options.update(conversion.json());
  if (tolerance.asked()) all_options["tolerance"] = tolerance.text;
  Json json = {{"grid", grid_json(loaded.grid)},
               {"options", all_options},
               {"rays", {{"primary", stats.primary_rays}, {"shadow", stats.shadow_rays}}},
               {"hits", stats.hits},
               {"counts", {{"primary", counts_json(stats.primary)}, {"shadow", counts_json(stats.shadow)}}},
               {"ms",
                {{"load", load_ms},
                 {"prepare", times_json(stats.prepare_ms)},
                 {"trace", times_json(stats.trace_ms)},
                 {"shade", times_json(stats.shade_ms)},
                 {"write", write_ms},
                 {"total", total.ms()}}},
               {"warnings", warnings}};
  if (tolerable) json["tolerance"] = tolerable->json;
  add_field_facts(json, loaded);
  write_json(common, json);
}

} // namespace

void add_render(CLI::App& program, Work& run) {
  auto options = std::make_shared<Render>();
  CLI::App& command = *program.add_subcommand("render", "Render a mesh or a level set to OpenEXR or PNG");
  command.footer(R"(Examples:
  levelray render statue.vdb -o statue.png
  levelray render statue.ply -o statue.exr -o statue.png --size 1920x1080 --shadows --ground
  levelray render statue.vdb -o statue.exr --aov t,P,N --eye 2,1,3 --target 0,0,0 --fov 35
  levelray render statue.vdb -o statue.png --light 1,2,1 --light -2,1,0,0.4 --samples 16
  levelray render statue.ply -o statue.png --tolerance 0.25px
  levelray render 'cache/liquid.####.vdb' -f 1001-1100 -o 'out/liquid.####.exr' --skip-existing
  levelray render statue.vdb --turntable 120 -o 'turn/statue.####.png' --movie turn.mp4
  levelray render shot.json -f 1001-1100 -o 'out/shot.####.exr' --set film.samples=4

Renders a level set, a mesh that is converted on the fly, or a scene ("levelray scene init" starts one). Without a camera all of it is framed; without lights
there are three that go along with the camera. Backgrounds are transparent (alpha 0; Z and t are 1e30 there, other
AOVs 0).

With -f the frame's number replaces ####, %04d or {frame} in paths. All frames have one camera: without --eye and
--target it sees all of the first, middle and last frame of -f; where parts of a sequence are rendered by
themselves, name these frames by --camera-frames. A frame that fails is reported and the others go on (exit 4).)");
  command
      .add_option("IN", options->input.path,
                  "A .vdb, a mesh, or a scene (.json); -: a mesh on standard input (needs --format)")
      ->required();
  command
      .add_option(
          "--set", options->overrides,
          "Change a scene's value, e.g. film.samples=4 or objects.dragon.material.ior=1.3; may be repeated")
      ->allow_extra_args(false)
      ->type_name("KEY=VALUE");
  options->picture.add_to(command);
  options->frames.add_to(command);
  options->conversion.add_to(command);
  options->tolerance.add_to(command, true);
  options->input.add_to(command);
  options->common.add_to(command);
  command.callback([options, &run, &command] { run = [options, &command] { options->run(command); }; });
}

} // namespace levelray
