// Jobs of many pictures: sequences and turntables, and movies of them.
#pragma once

#include "movie.hpp"
#include "picture_frames.hpp"

namespace levelray {

struct RenderFramesOptions {
  SequenceOptions sequence;
  int turntable = 0;
  std::string camera_frames, movie, background = "0.2,0.2,0.2";
  double fps = 24;

  void add_to(CLI::App& command);
  // As plan_frames, of pictures; with the movie's options checked.
  FramePlan plan(const std::vector<std::string>& inputs, const std::vector<std::string>& outputs) const;
  // Whether that is a job of frames, and not of one picture.
  bool many(const FramePlan& plan) const { return plan.numbered || sequence.skip_existing || !movie.empty(); }
  MovieOptions movie_options() const;
  Json json() const;
};

// Renders the frames of level sets or meshes.
void render_frames(const FramePlan& plan, const CommonOptions& common, const InputOptions& input,
                   const ConversionOptions& conversion, const PictureOptions& picture,
                   const RenderFramesOptions& options);

// Renders the frames of any source, makes the movie if one is asked for, and reports. `more` goes to the
// JSON summary.
void render_source(const FrameSource& source, Sequence& sequence, SequenceReport& report,
                   const RenderFramesOptions& options, const Json& more);

} // namespace levelray
