#include "sequence_options.hpp"

#include "levelray/core/error.hpp"
#include "levelray/io/frame_list.hpp"
#include "names.hpp"

#include <filesystem>
#include <fmt/format.h>
#include <unordered_set>

namespace levelray {

namespace fs = std::filesystem;

void SequenceOptions::add_to(CLI::App& command) {
  const std::string group = "Sequence";
  command
      .add_option(
          "--frames,-f", frames,
          "Frames: 1-100, 1-100x2, 1,5,9, -10--1; their number replaces ####, %04d or {frame} in paths")
      ->type_name("LIST")
      ->group(group);
  command
      .add_option("--missing", missing,
                  "Where a frame's input is missing: error (the others go on), skip, or hold the one before")
      ->capture_default_str()
      ->type_name("NAME")
      ->group(group);
  command
      .add_flag("--skip-existing", skip_existing,
                "Leave frames alone that are there, whole, and made of the same inputs by the same options")
      ->group(group);
  command.add_flag("--fail-fast", fail_fast, "Stop at the first frame that fails")->group(group);
  command
      .add_option("--frame-timeout", frame_timeout,
                  "Give up a frame whose loading and rendering take longer, in seconds; 0: never")
      ->check(CLI::Range(0.0, 1e9))
      ->capture_default_str()
      ->type_name("S")
      ->group(group);
}

Json SequenceOptions::json() const {
  return {{"frames", frames},
          {"missing", missing},
          {"skip_existing", skip_existing},
          {"fail_fast", fail_fast},
          {"frame_timeout", frame_timeout}};
}

std::vector<std::string> FramePlan::output_paths(int frame) const {
  std::vector<std::string> paths;
  for (const FramePattern& output : outputs) paths.push_back(output.path(frame));
  return paths;
}

namespace {

[[noreturn]] void refuse(ErrorKind kind, const std::string& path, const std::string& reason) {
  throw Error(kind, printable(path, 250) + ": " + reason);
}

// An existing file may have '#' or "%d" in its name.
FramePattern input_pattern(const std::string& path) {
  std::error_code ignored;
  return fs::exists(path, ignored) ? FramePattern::literal(path) : FramePattern(path);
}

std::string found(const FramePattern& input) {
  const std::string frames = frames_text(input.existing(), 80);
  return frames.empty() ? "found none" : "found " + frames;
}

} // namespace

FramePlan plan_frames(const SequenceOptions& options, const std::vector<int>& all_frames,
                      const std::vector<std::string>& inputs, const std::vector<std::string>& outputs,
                      const std::vector<std::string>& extensions) {
  find_name("--missing", options.missing, {"error", "skip", "hold"});
  FramePlan plan;
  plan.numbered = !options.frames.empty() || all_frames.size() > 1;
  plan.frames = options.frames.empty() ? all_frames : parse_frames("--frames", options.frames);
  for (const std::string& path : inputs) plan.inputs.push_back(input_pattern(path));
  for (const std::string& path : outputs) plan.outputs.emplace_back(path);

  for (const FramePattern& input : plan.inputs)
    if (input.has_frame()) {
      if (!plan.numbered)
        refuse(ErrorKind::usage, input.text(),
               "a place for frames needs -f; " + found(input) +
                   (input.existing().empty() ? "" : ", add -f " + frames_text(input.existing(), 80)));
      const bool any = std::any_of(plan.frames.begin(), plan.frames.end(), [&](int frame) {
        std::error_code ignored;
        return fs::exists(input.path(frame), ignored);
      });
      if (!any && options.missing != "hold")
        refuse(ErrorKind::bad_input, input.text(),
               fmt::format("none of the frames {} exists; {}", frames_text(plan.frames, 80), found(input)));
    }
  for (const FramePattern& output : plan.outputs) {
    if (output.has_frame() && !plan.numbered)
      refuse(ErrorKind::usage, output.text(), "a place for frames needs -f, e.g. -f 1-100");
    if (!output.has_frame() && plan.frames.size() > 1)
      refuse(ErrorKind::usage, output.text(),
             fmt::format("one file for {} frames; put #### where the number goes", plan.frames.size()));
  }

  std::unordered_set<std::string> read;
  for (const int frame : plan.frames)
    for (const FramePattern& input : plan.inputs)
      read.insert(fs::path(input.path(frame)).lexically_normal().string());
  std::vector<std::string> written;
  for (const FramePattern& output : plan.outputs) {
    const std::string input = plan.inputs.empty() ? "/" : plan.inputs.front().path(plan.frames.front());
    check_output(output.path(plan.frames.front()), input, extensions, written);
    const bool many_folders =
        fs::path(output.text()).parent_path() != fs::path(output.path(plan.frames.front())).parent_path();
    for (const int frame : plan.frames) {
      const fs::path path = output.path(frame);
      if (read.count(path.lexically_normal().string()))
        refuse(ErrorKind::usage, path, "the output is an input");
      std::error_code ignored;
      if (many_folders && !fs::is_directory(path.parent_path(), ignored))
        refuse(ErrorKind::usage, path, "the output's folder does not exist; create it first");
    }
  }
  return plan;
}

} // namespace levelray
