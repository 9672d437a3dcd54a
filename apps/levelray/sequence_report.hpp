// What people and programs are told of a sequence: a line per frame, progress, a summary.
#pragma once

#include "console.hpp"
#include "options.hpp"

#include <set>

namespace levelray {

// How a frame ended.
struct FrameResult {
  enum class Status { made, skipped, missing, failed };
  int frame = 0;
  Status status = Status::made;
  std::vector<std::string> inputs, outputs;
  std::string error;           // of missing and failed frames
  int exit_code = 0;           // that a job of this frame alone would end with
  Json facts = Json::object(); // more for the JSON line
  std::vector<std::string> warnings;
  double seconds = 0; // from its turn to its file
};

// "frame 43/100  43%  45.8 frames/min  1:15 left". `done` frames are over, `made` of them (a fraction counts)
// in `seconds` of work; those that are left are thought to take as long each.
std::string sequence_progress_text(std::size_t done, double made, std::size_t all, double seconds);

// All functions may be called from any thread.
class SequenceReport {
 public:
  // `verb`: what is done to frames, "rendered". With --json FILE the lines go to that file, begun anew, as
  // they come. Throws Error(cannot_write).
  SequenceReport(const CommonOptions& common, const char* verb, std::size_t frames);
  ~SequenceReport();
  SequenceReport(const SequenceReport&) = delete;
  SequenceReport& operator=(const SequenceReport&) = delete;

  // Tells the frame's end: JSON lines have status "rendered" (the verb), "skipped", "missing" or "failed".
  void add(const FrameResult& result);
  // How far the frame that is being made has come, in [0,1].
  void progress(double fraction);
  // The last line: counts, lists of frames, rate, peak memory, and `more`. Throws Error(some_frames) when
  // frames failed: "2 of 100 frames failed: 7, 9; first: ...".
  void finish(const Json& more);
  // In the place of it, on standard error, when the job was stopped.
  void stopped();

  std::vector<int> failed() const;
  std::vector<int> missing() const;

 private:
  void line(const Json& json);
  std::string counts() const;
  double seconds() const;

  mutable std::mutex mutex_;
  const CommonOptions& common_;
  const std::string verb_;
  const std::size_t all_;
  Progress progress_;
  int json_file_ = -1;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::size_t made_ = 0, skipped_ = 0;
  double idle_seconds_ = 0; // before the first frame that had to be made
  std::vector<int> missing_, failed_;
  std::string first_failure_;
  std::set<std::string> warnings_; // that were told
};

} // namespace levelray
