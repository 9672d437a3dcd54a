// Makes the frames of a sequence, one after the other: while one is made, the next one loads and the one
// before is written.
#pragma once

#include "frame_inputs.hpp"
#include "sequence_report.hpp"

#include <functional>
#include <memory>

namespace levelray {

// What a frame is made of, in memory. Kept as long as the next frames are made of the same.
struct LoadedFrame {
  virtual ~LoadedFrame() = default;
  std::uint64_t bytes = 0;
  std::vector<std::string> warnings;
};

// A frame that has to be written yet.
struct MadeFrame {
  std::function<void(const std::string& scene_hash)> write; // called in another thread
  std::uint64_t bytes = 0;                                  // held until it is written
  Json facts = Json::object();                              // for the frame's line
  std::vector<std::string> warnings;
};

// What the frames of a job are: a picture of a level set, a converted mesh, a scene.
class FrameSource {
 public:
  virtual ~FrameSource() = default;

  // What is done to frames, for people: "rendered".
  virtual const char* verb() const = 0;
  // Every option in force that decides the frame's bytes, besides the content of its inputs.
  virtual std::string settings(int frame) const = 0;
  // Loads the files, one per input of the plan, within `memory` bytes. Called in another thread than make,
  // under a TimeLimit with `seconds` left.
  virtual std::shared_ptr<const LoadedFrame> load(const std::vector<std::string>& paths, std::uint64_t memory,
                                                  double seconds) const = 0;
  // The memory that make takes besides what is loaded, in bytes.
  virtual std::uint64_t making_bytes() const = 0;
  // The outputs are the plan's paths of this frame. `progress` takes [0,1], from any thread.
  virtual MadeFrame make(int frame, std::shared_ptr<const LoadedFrame> loaded,
                         const std::vector<std::string>& outputs,
                         const std::function<void(double)>& progress) const = 0;
};

class Sequence {
 public:
  // `memory_limit` in bytes holds for what is loaded, made and written at the same time.
  Sequence(FramePlan plan, const SequenceOptions& options, std::uint64_t memory_limit);

  const FramePlan& plan() const { return plan_; }

  // Loads the first `wanted` of `frames` one by one, and shows them; when none of them can be loaded, the
  // first of the others that can. The last one is kept for its own turn. Each one that cannot be loaded adds
  // a line to `problems`. Throws the first problem when there is nothing to show.
  void show(const FrameSource& source, const std::vector<int>& frames, std::size_t wanted,
            const std::function<void(int frame, const LoadedFrame&)>& shown,
            std::vector<std::string>& problems);

  // Makes all frames. A frame that fails is reported, and the others go on (unless --fail-fast);
  // Error(cannot_write) ends the job. Throws Cancelled after having told how far it came.
  void run(const FrameSource& source, SequenceReport& report);

 private:
  struct Prepared;

  // What there is for loading when nothing else is held.
  std::uint64_t all_memory(const FrameSource& source) const;
  Prepared prepare(const FrameSource& source, int frame, std::uint64_t memory);
  void prepare_or_throw(const FrameSource& source, std::uint64_t memory, Prepared& prepared);
  std::shared_ptr<const LoadedFrame> load(const FrameSource& source, const FrameInputs::Found& inputs,
                                          std::uint64_t memory);

  FramePlan plan_;
  SequenceOptions options_;
  std::uint64_t memory_limit_;
  FrameInputs inputs_;
  std::string kept_content_; // what kept_ was loaded from
  std::shared_ptr<const LoadedFrame> kept_;
};

} // namespace levelray
