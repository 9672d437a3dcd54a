#include "picture_frames.hpp"

#include "levelray/core/error.hpp"
#include "levelray/io/exr_writer.hpp"
#include "levelray/io/output_file.hpp"
#include "levelray/io/png_writer.hpp"
#include "levelray/render/false_colour.hpp"
#include "levelray/render/scene.hpp"
#include "levelray/trace/level_set.hpp"
#include "turntable.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace levelray {

namespace {

constexpr const char* channel_comments =
    "R, G, B premultiplied by A, scene-linear. Z: depth along the view axis; t: distance along the ray; P, "
    "N: "
    "world position and unit outward normal; id: the number of the object, or of the ground; steps, tests, "
    "interpolations, samples: work done for the ray; shadow_steps, shadow_tests: for the rays towards "
    "lights, "
    "per sample. AOVs are of the pixel's centre, unfiltered. Where A is 0: Z = t = 1e30, P = N = id = 0.";

struct LoadedSurface : LoadedFrame {
  LoadedGrid file;
  std::optional<LevelSet> level_set; // of the file's grid
};

const BlockGrid& grid_of(const LoadedFrame& loaded) {
  return static_cast<const LoadedSurface&>(loaded).file.grid;
}

Json vector_json(const Vec3d& v) {
  return {v.x, v.y, v.z};
}

} // namespace

void write_picture(const std::string& path, const Image& image, const Camera& camera,
                   const std::string& scene_hash, std::optional<int> frame, const std::string& legend) {
  if (extension_of(path) == ".png") return write_file_atomically(path, encode_png(image, scene_hash));
  ExrOptions options;
  options.camera = &camera;
  options.software = "levelray " LEVELRAY_VERSION;
  options.comments = channel_comments + legend;
  options.frame = frame;
  options.scene_hash = scene_hash;
  write_file_atomically(path, encode_exr(image, options));
}

void check_render_memory(const PictureOptions& picture, const RenderOptions& options,
                         std::uint64_t grid_bytes, std::uint64_t limit) {
  if (const std::uint64_t needed = render_bytes(options) + grid_bytes; needed > limit)
    throw Error(ErrorKind::limit, fmt::format("--size {}: rendering needs {}, --max-memory is {}",
                                              picture.size, bytes_text(needed), bytes_text(limit)));
}

std::string show_counter(const PictureOptions& picture, Image& image) {
  if (picture.show.empty()) return "";
  return fmt::format(" R, G, B: {} in false colours, white is {}.", picture.show,
                     show_channel(image, picture.show));
}

PictureFrames::PictureFrames(const InputOptions& input, const ConversionOptions& conversion,
                             const PictureOptions& picture, int turntable)
    : input_(input), conversion_(conversion), picture_(picture), turntable_(turntable),
      seen_(picture.resolve_without_grid().camera) {
  if (!needs_settling()) settle();
}

bool PictureFrames::needs_settling() const {
  return picture_.needs_framing() || picture_.ground;
}

void PictureFrames::see(const LoadedFrame& loaded) {
  if (turntable_ > 0)
    seen_.add_turning(grid_of(loaded));
  else
    seen_.add(grid_of(loaded));
}

void PictureFrames::settle() {
  options_ = picture_.resolve(seen_);
  if (!options_.ground) return;
  ground_.emplace().up = options_.camera.up;
  seen_.place(*ground_);
}

RenderOptions PictureFrames::options_of(int frame) const {
  RenderOptions options = options_;
  if (turntable_ > 0) {
    options.camera = turned_camera(options.camera, static_cast<double>(frame - 1) / turntable_);
    if (picture_.lights.empty()) options.lights = three_point_lights(Camera(options.camera));
  }
  return options;
}

std::string PictureFrames::settings(int frame) const {
  const RenderOptions options = options_of(frame);
  Json json = picture_.json(options, 0);
  for (const char* key : {"threads", "output", "repeat"}) json.erase(key);
  if (ground_ && ground_->height)
    json["ground"] = {{"height", *ground_->height},
                      {"centre", vector_json(*ground_->centre)},
                      {"radius", *ground_->radius}};
  json.update(input_.lasting_json());
  json.update(conversion_.json());
  return json.dump();
}

std::shared_ptr<const LoadedFrame> PictureFrames::load(const std::vector<std::string>& paths,
                                                       std::uint64_t memory, double seconds) const {
  const InputOptions input = input_.of_frame(paths.front(), memory, seconds);
  const CommonOptions silent = CommonOptions::silent();
  Progress none(true);
  auto loaded = std::make_shared<LoadedSurface>();
  loaded->file = load_grid(input, conversion_, silent, none);
  loaded->level_set.emplace(loaded->file.grid);
  loaded->bytes = loaded->file.grid.bytes() + loaded->level_set->bytes();
  loaded->warnings = loaded->file.warnings;
  return loaded;
}

std::uint64_t PictureFrames::making_bytes() const {
  // The size of pictures is known before the camera is.
  return render_bytes(picture_.resolve_without_grid());
}

MadeFrame PictureFrames::make(int frame, std::shared_ptr<const LoadedFrame> loaded,
                              const std::vector<std::string>& outputs,
                              const std::function<void(double)>& progress) const {
  RenderOptions options = options_of(frame);
  options.repeat = 1;
  options.progress = progress;
  Scene scene = one_grid_scene(grid_of(*loaded), options);
  scene.instances.front().level_set = &*static_cast<const LoadedSurface&>(*loaded).level_set;
  if (ground_) scene.ground = ground_;
  auto rendered = std::make_shared<RenderedImage>(render_image(scene, options));
  const std::string legend = show_counter(picture_, rendered->image);
  const RenderStats& stats = rendered->stats;

  MadeFrame made;
  made.bytes = render_bytes(options);
  made.facts = {{"rays", {{"primary", stats.primary_rays}, {"shadow", stats.shadow_rays}}},
                {"hits", stats.hits},
                {"ms",
                 {{"prepare", stats.prepare_ms.front()},
                  {"trace", stats.trace_ms.front()},
                  {"shade", stats.shade_ms.front()}}}};
  add_field_facts(made.facts, static_cast<const LoadedSurface&>(*loaded).file);
  if (stats.hits == 0) made.warnings.push_back("no ray met the surface");
  made.write = [rendered, outputs, frame, legend, settings = options.camera](const std::string& scene_hash) {
    const Camera camera(settings);
    for (const std::string& output : outputs)
      write_picture(output, rendered->image, camera, scene_hash, frame, legend);
  };
  return made;
}

} // namespace levelray
