#include "frame_inputs.hpp"

#include "levelray/core/content_hash.hpp"
#include "levelray/core/error.hpp"
#include "levelray/core/parallel.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

namespace levelray {

namespace {

std::string content_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::vector<char> buffer(std::size_t{1} << 20);
  ContentHash hash;
  while (file.read(buffer.data(), static_cast<std::streamsize>(buffer.size())), file.gcount() > 0) {
    check_cancel();
    hash.add(buffer.data(), static_cast<std::size_t>(file.gcount()));
  }
  if (file.bad() || !file.eof())
    throw Error(ErrorKind::bad_input, printable(path, 300) + ": cannot be read: " + std::strerror(errno));
  return hash.uuid();
}

} // namespace

FrameInputs::FrameInputs(const std::vector<FramePattern>& inputs, const std::string& missing)
    : inputs_(inputs), missing_(missing) {
  if (missing_ != "hold") return;
  for (const FramePattern& input : inputs_) existing_.push_back(input.existing());
}

FrameInputs::Found FrameInputs::find(int frame) {
  Found found;
  for (std::size_t i = 0; i < inputs_.size(); ++i) {
    std::string path = inputs_[i].path(frame);
    std::error_code ignored;
    if (!std::filesystem::exists(path, ignored)) {
      const std::string problem = printable(path, 300) + ": no such file";
      if (missing_ == "hold" && inputs_[i].has_frame()) {
        const std::vector<int>& there = existing_[i];
        const auto later = std::upper_bound(there.begin(), there.end(), frame);
        if (later == there.begin()) {
          found.missing = problem + ", and no earlier frame to hold";
        } else {
          path = inputs_[i].path(*(later - 1));
          found.held = true;
        }
      } else {
        found.missing = problem;
      }
    }
    found.paths.push_back(path);
  }
  if (!found.missing.empty()) return found;

  std::map<std::string, Content> contents;
  std::string all;
  for (const std::string& path : found.paths) {
    const FileState state = file_state(path);
    const auto known = contents_.find(path);
    Content& content = contents[path];
    if (known != contents_.end() && known->second.state == state)
      content = known->second;
    else
      content = {state, content_of(path)};
    all += content.hash + "\n";
  }
  contents_ = std::move(contents);
  found.content = all;
  return found;
}

void FrameInputs::check_unchanged(const Found& found) const {
  for (const std::string& path : found.paths)
    if (const auto known = contents_.find(path); known != contents_.end())
      levelray::check_unchanged(path, known->second.state);
}

} // namespace levelray
