// The options of jobs of many frames, and the plan that comes of them.
#pragma once

#include "levelray/io/frame_pattern.hpp"
#include "options.hpp"

namespace levelray {

struct SequenceOptions {
  std::string frames, missing = "error";
  bool skip_existing = false, fail_fast = false;
  double frame_timeout = 0; // seconds for loading and making a frame; 0: no limit

  void add_to(CLI::App& command);
  Json json() const;
};

// What a job reads and writes, frame by frame.
struct FramePlan {
  std::vector<int> frames; // in the order they are made
  std::vector<FramePattern> inputs, outputs;
  bool numbered = false; // whether frames were asked for at all

  std::vector<std::string> output_paths(int frame) const;
};

// Checks a job before any work. `all_frames`: what is made when -f is not given (a turntable's turn, or one
// nameless frame). Throws Error(usage) for illegal lists and patterns, for a pattern without frames (telling
// which exist), several frames with one output, outputs that are inputs; Error(bad_input) when no frame of a
// pattern exists; Error(cannot_write) when the first frame's outputs could not be created.
FramePlan plan_frames(const SequenceOptions& options, const std::vector<int>& all_frames,
                      const std::vector<std::string>& inputs, const std::vector<std::string>& outputs,
                      const std::vector<std::string>& extensions);

} // namespace levelray
