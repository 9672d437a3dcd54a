// The files that a frame is made of: which they are, and what is in them.
#pragma once

#include "file_state.hpp"
#include "sequence_options.hpp"

#include <map>

namespace levelray {

class FrameInputs {
 public:
  FrameInputs(const std::vector<FramePattern>& inputs, const std::string& missing);

  struct Found {
    std::vector<std::string> paths; // one per input
    std::string missing;            // "path: no such file", or empty
    bool held = false;              // an earlier frame stands in
    std::string content;            // hash of the bytes of all of them; empty when one is missing
  };
  // Reads the files, to hash them. Throws Error(bad_input) for what cannot be read, Cancelled, TimeUp.
  Found find(int frame);

  // Throws Error(bad_input) when a file is no longer what find() saw: other size, time or place on disk.
  void check_unchanged(const Found& found) const;

 private:
  struct Content {
    FileState state;
    std::string hash;
  };

  std::vector<FramePattern> inputs_;
  std::string missing_;
  std::vector<std::vector<int>> existing_;  // per input, when --missing hold
  std::map<std::string, Content> contents_; // of the last frame: most often the next one's, too
};

} // namespace levelray
