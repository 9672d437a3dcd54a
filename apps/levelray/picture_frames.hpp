// Frames that are pictures of a level set or a mesh.
#pragma once

#include "input.hpp"
#include "levelray/render/scene.hpp"
#include "render_options.hpp"
#include "sequence.hpp"

namespace levelray {

// Writes an .exr or .png with the camera's matrices; with a scene hash, stamped.
// `legend`: more for the comments.
void write_picture(const std::string& path, const Image& image, const Camera& camera,
                   const std::string& scene_hash = "", std::optional<int> frame = {},
                   const std::string& legend = "");

// With --show, makes the picture that of the counter; says, for the comments, what its colours mean.
std::string show_counter(const PictureOptions& picture, Image& image);

// Throws Error(limit) when rendering with a grid of that size takes more than the limit.
void check_render_memory(const PictureOptions& picture, const RenderOptions& options,
                         std::uint64_t grid_bytes, std::uint64_t limit);

class PictureFrames : public FrameSource {
 public:
  // `turntable`: frames of a turn of the camera, or 0. Everything must outlive this.
  PictureFrames(const InputOptions& input, const ConversionOptions& conversion, const PictureOptions& picture,
                int turntable);

  // Camera, lights and ground are the same for all frames. Where the options leave them open, they go by the
  // surfaces of the frames that are shown to `see`, and then settled.
  bool needs_settling() const;
  void see(const LoadedFrame& loaded);
  void settle();
  RenderOptions options_of(int frame) const;

  const char* verb() const override { return "rendered"; }
  std::string settings(int frame) const override;
  std::shared_ptr<const LoadedFrame> load(const std::vector<std::string>& paths, std::uint64_t memory,
                                          double seconds) const override;
  std::uint64_t making_bytes() const override;
  MadeFrame make(int frame, std::shared_ptr<const LoadedFrame> loaded,
                 const std::vector<std::string>& outputs,
                 const std::function<void(double)>& progress) const override;

 private:
  const InputOptions& input_;
  const ConversionOptions& conversion_;
  const PictureOptions& picture_;
  const int turntable_;
  Framing seen_;
  std::optional<GroundSettings> ground_; // in one place for all frames
  RenderOptions options_;                // of frame 1 of a turntable; of all frames otherwise
};

} // namespace levelray
