#include "scene_frames.hpp"

#include "file_state.hpp"
#include "levelray/core/error.hpp"
#include "picture_frames.hpp"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>

namespace levelray {

namespace fs = std::filesystem;

struct SceneFrames::Loaded {
  std::string path;
  FileState state;
  LoadedGrid file;
  std::optional<LevelSet> level_set;
  std::uint64_t bytes = 0;
};

struct SceneFrames::LoadedScene : LoadedFrame {
  std::vector<std::shared_ptr<const Loaded>> files; // one per input
};

SceneFrames::SceneFrames(const SceneFile& scene, const InputOptions& input, const PictureOptions& picture)
    : scene_(scene), input_(input), picture_(picture), inputs_(scene_inputs(scene)),
      kept_(inputs_.files.size()) {}

std::vector<std::string> SceneFrames::input_paths() const {
  std::vector<std::string> paths;
  for (const SceneInput& file : inputs_.files) paths.push_back(file.path);
  return paths;
}

std::string SceneFrames::settings(int frame) const {
  Json reading = input_.lasting_json();
  reading["show"] = picture_.show;
  reading.update(picture_.acceleration.json()); // which the counters tell of
  return frame_text(scene_, inputs_, frame) + "\n" + reading.dump();
}

std::shared_ptr<const SceneFrames::Loaded> SceneFrames::load_file(std::size_t index, const std::string& path,
                                                                  std::uint64_t memory,
                                                                  double seconds) const {
  const SceneInput& file = inputs_.files[index];
  auto loaded = std::make_shared<Loaded>();
  loaded->path = path;
  std::error_code ignored;
  const bool exists = fs::exists(path, ignored); // what is not there is the reader's to complain about
  if (exists) loaded->state = file_state(path);
  if (exists && is_vdb(path) == file.is_mesh)
    throw Error(ErrorKind::usage,
                fmt::format("{}: {} is {}; use the key \"{}\"", file.place, printable(path, 250),
                            file.is_mesh ? "a level set" : "no .vdb", file.is_mesh ? "level_set" : "mesh"));
  const InputOptions input = input_of(file, input_).of_frame(path, memory, seconds);
  const CommonOptions silent = CommonOptions::silent();
  Progress none(true);
  try {
    loaded->file = load_grid(input, conversion_of(file), silent, none);
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::usage) throw;
    throw Error(error.kind(), file.place + ": " + error.what()); // an option that stands in the scene
  }
  loaded->level_set.emplace(loaded->file.grid);
  loaded->bytes = loaded->file.grid.bytes() + loaded->level_set->bytes();
  return loaded;
}

std::shared_ptr<const LoadedFrame> SceneFrames::load(const std::vector<std::string>& paths,
                                                     std::uint64_t memory, double seconds) const {
  const std::lock_guard lock(mutex_);
  const auto is_kept = [&](std::size_t i) {
    return kept_[i] && kept_[i]->path == paths[i] && kept_[i]->state == file_state(paths[i]);
  };
  for (std::size_t i = 0; i < paths.size(); ++i)
    if (!is_kept(i)) kept_[i].reset();
  auto scene = std::make_shared<LoadedScene>();
  std::uint64_t used = 0; // by what is loaded now: what is kept was there before
  for (std::size_t i = 0; i < paths.size(); ++i) {
    if (!kept_[i]) {
      kept_[i] = load_file(i, paths[i], memory - std::min(memory, used), seconds);
      used += kept_[i]->bytes;
    }
    scene->files.push_back(kept_[i]);
    scene->bytes += kept_[i]->bytes;
    for (const std::string& warning : kept_[i]->file.warnings)
      scene->warnings.push_back(fmt::format("{}: {}", printable(paths[i], 200), warning));
  }
  return scene;
}

std::uint64_t SceneFrames::making_bytes() const {
  RenderOptions options;
  options.camera.width = scene_.film.size[0];
  options.camera.height = scene_.film.size[1];
  options.aovs = scene_.film.aov;
  return render_bytes(options);
}

MadeFrame SceneFrames::make(int frame, std::shared_ptr<const LoadedFrame> loaded,
                            const std::vector<std::string>& outputs,
                            const std::function<void(double)>& progress) const {
  const auto& files = static_cast<const LoadedScene&>(*loaded).files;
  std::vector<const BlockGrid*> grids;
  for (const auto& file : files) grids.push_back(&file->file.grid);
  Scene scene = scene_at(scene_, inputs_, frame, grids);
  for (std::size_t i = 0; i < scene.instances.size(); ++i)
    scene.instances[i].level_set = &*files[inputs_.of_object[i]]->level_set;
  RenderOptions options = render_options_at(scene_, frame);
  options.acceleration = picture_.acceleration.resolve();
  options.progress = progress;
  auto rendered = std::make_shared<RenderedImage>(render_image(scene, options));
  const std::string legend = show_counter(picture_, rendered->image);
  const RenderStats& stats = rendered->stats;

  MadeFrame made;
  made.bytes = render_bytes(options);
  made.facts = {
      {"rays",
       {{"primary", stats.primary_rays}, {"shadow", stats.shadow_rays}, {"secondary", stats.secondary_rays}}},
      {"hits", stats.hits},
      {"ms",
       {{"prepare", stats.prepare_ms.front()},
        {"trace", stats.trace_ms.front()},
        {"shade", stats.shade_ms.front()}}}};
  if (stats.hits == 0) made.warnings.push_back("no ray met an object; look at camera.eye and camera.target");
  made.write = [rendered, outputs, frame, legend, settings = options.camera](const std::string& scene_hash) {
    const Camera camera(settings);
    const std::optional<int> number =
        scene_hash.empty() ? std::optional<int>() : frame; // of a frame of a job
    for (const std::string& output : outputs)
      write_picture(output, rendered->image, camera, scene_hash, number, legend);
  };
  return made;
}

} // namespace levelray
