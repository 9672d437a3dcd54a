// Frames that are pictures of a scene file.
#pragma once

#include "levelray/trace/level_set.hpp"
#include "render_options.hpp"
#include "scene_input.hpp"
#include "sequence.hpp"

#include <mutex>

namespace levelray {

class SceneFrames : public FrameSource {
 public:
  // `input`: how files are read, besides what the scene says of each; of `picture`, how rays are spared work
  // and what is shown of it. All must outlive this.
  SceneFrames(const SceneFile& scene, const InputOptions& input, const PictureOptions& picture);

  // What the frames are made of: patterns, one per input of the plan.
  std::vector<std::string> input_paths() const;

  const char* verb() const override { return "rendered"; }
  std::string settings(int frame) const override;
  // Keeps what was loaded last: files that stay the same from frame to frame are read once.
  std::shared_ptr<const LoadedFrame> load(const std::vector<std::string>& paths, std::uint64_t memory,
                                          double seconds) const override;
  std::uint64_t making_bytes() const override;
  MadeFrame make(int frame, std::shared_ptr<const LoadedFrame> loaded,
                 const std::vector<std::string>& outputs,
                 const std::function<void(double)>& progress) const override;

 private:
  // A file in memory, and what tells whether it is still the same on disk.
  struct Loaded;
  struct LoadedScene;
  std::shared_ptr<const Loaded> load_file(std::size_t index, const std::string& path, std::uint64_t memory,
                                          double seconds) const;

  const SceneFile& scene_;
  const InputOptions& input_;
  const PictureOptions& picture_;
  const SceneInputs inputs_;
  mutable std::mutex mutex_;
  mutable std::vector<std::shared_ptr<const Loaded>> kept_; // of the last frame, one per input
};

} // namespace levelray
