// levelray render: a mesh or a level set to a picture.
#include "commands.hpp"
#include "input.hpp"
#include "levelray/core/error.hpp"
#include "levelray/core/parallel.hpp"
#include "levelray/io/exr_writer.hpp"
#include "levelray/io/output_file.hpp"
#include "levelray/io/png_writer.hpp"
#include "levelray/render/false_colour.hpp"
#include "render_options.hpp"

#include <fmt/format.h>
#include <memory>

namespace levelray {

namespace {

constexpr const char* channel_comments =
    "R, G, B premultiplied by A, scene-linear. Z: depth along the view axis; t: distance along the ray; P, "
    "N: world "
    "position and unit outward normal; steps, tests, interpolations, samples: work done for the ray; "
    "shadow_steps, shadow_tests: for the rays towards lights, per sample. AOVs are of the pixel's centre, "
    "unfiltered. Where A is 0: Z = t = 1e30, P = N = 0.";

struct Render {
  CommonOptions common;
  InputOptions input;
  ConversionOptions conversion;
  PictureOptions picture;

  void run() const;
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

void write_picture(const std::string& path, const Image& image, const Camera& camera,
                   const std::string& legend) {
  if (extension_of(path) == ".png")
    write_file_atomically(path, encode_png(image));
  else
    write_file_atomically(path, encode_exr(image, {&camera, "levelray " LEVELRAY_VERSION,
                                                   std::string(channel_comments) + legend}));
}

void Render::run() const {
  picture.check();
  std::vector<std::string> outputs;
  for (const std::string& output : picture.outputs)
    check_output(output, input.path, {".exr", ".png"}, outputs);
  if (!common.json.empty() && common.json != "-") check_output(common.json, input.path, {}, outputs);

  const ThreadLimit threads(common.threads);
  const Stopwatch total;
  Progress progress(common.quiet);
  const LoadedGrid loaded = load_grid(input, conversion, common, progress);
  const double load_ms = total.ms();

  RenderOptions options = picture.resolve(loaded.grid);
  const std::uint64_t needed = render_bytes(options) + loaded.grid.bytes();
  if (const std::uint64_t limit = input.memory_limit(); limit > 0 && needed > limit)
    throw Error(ErrorKind::limit, fmt::format("--size {}: rendering needs {}, --max-memory is {}",
                                              picture.size, bytes_text(needed), bytes_text(limit)));
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

  std::string legend;
  if (!picture.show.empty())
    legend = fmt::format(" R, G, B: {} in false colours, white is {}.", picture.show,
                         show_channel(rendered.image, picture.show));

  const Stopwatch write;
  const Camera camera(options.camera);
  for (const std::string& output : picture.outputs) write_picture(output, rendered.image, camera, legend);
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

Renders a level set, or a mesh that is converted on the fly. Without a camera all of it is framed; without lights
there are three that go along with the camera. Backgrounds are transparent (alpha 0; Z and t are 1e30 there, other
AOVs 0).)");
  command
      .add_option("IN", options->input.path, "A .vdb or a mesh; -: a mesh on standard input (needs --format)")
      ->required();
  options->picture.add_to(command);
  options->conversion.add_to(command);
  options->input.add_to(command);
  options->common.add_to(command);
  command.callback([options, &run] { run = [options] { options->run(); }; });
}

} // namespace levelray
