#include "render_frames.hpp"

#include "levelray/core/error.hpp"
#include "levelray/core/parallel.hpp"
#include "levelray/io/frame_list.hpp"
#include "levelray/io/output_file.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <numeric>
#include <optional>

namespace levelray {

void RenderFramesOptions::add_to(CLI::App& command) {
  sequence.add_to(command);
  const std::string group = "Sequence";
  command
      .add_option("--camera-frames", camera_frames,
                  "The frames that an automatic camera sees all of, and whose lowest point the ground is "
                  "under; default: first, middle and last of -f")
      ->type_name("LIST")
      ->group(group);
  command.add_option("--turntable", turntable, "Go round a single input in N frames, 1 to N")
      ->check(CLI::Range(1, 1000000))
      ->type_name("N")
      ->group(group);
  command
      .add_option("--movie", movie,
                  "Make a movie of the first output's frames, too: .mp4, .mov or .mkv, by ffmpeg")
      ->type_name("FILE")
      ->group(group);
  command.add_option("--fps", fps, "Frames per second of the movie")
      ->capture_default_str()
      ->type_name("N")
      ->group(group);
  command
      .add_option("--movie-background", background,
                  "What is behind the picture in the movie, sRGB from 0 to 1")
      ->capture_default_str()
      ->type_name("R,G,B")
      ->group(group);
}

FramePlan RenderFramesOptions::plan(const std::vector<std::string>& inputs,
                                    const std::vector<std::string>& outputs) const {
  if (!movie.empty()) check_movie(movie_options());
  std::vector<int> turn(static_cast<std::size_t>(std::max(turntable, 1)));
  std::iota(turn.begin(), turn.end(), 1);
  FramePlan plan = plan_frames(sequence, turn, inputs, outputs, {".exr", ".png"});
  if (turntable > 0 && plan.inputs.front().has_frame())
    throw Error(ErrorKind::usage, "--turntable goes round one input: name a single file, or leave it out");
  std::vector<std::string> written = plan.output_paths(plan.frames.front());
  if (!movie.empty()) check_output(movie, inputs.front(), {}, written);
  return plan;
}

MovieOptions RenderFramesOptions::movie_options() const {
  return {movie, fps, parse_vector("--movie-background", background)};
}

Json RenderFramesOptions::json() const {
  Json json = sequence.json();
  json["camera_frames"] = camera_frames;
  json["turntable"] = turntable;
  json["movie"] = movie;
  json["fps"] = fps;
  json["movie_background"] = background;
  return json;
}

void render_frames(const FramePlan& plan, const CommonOptions& common, const InputOptions& input,
                   const ConversionOptions& conversion, const PictureOptions& picture,
                   const RenderFramesOptions& options) {
  std::vector<std::string> written;
  if (!common.json.empty() && common.json != "-") check_output(common.json, input.path, {}, written);
  conversion.check();
  parse_unit(input.units);
  std::vector<int> camera_frames = options.camera_frames.empty()
                                       ? framing_frames(plan.frames)
                                       : parse_frames("--camera-frames", options.camera_frames);
  check_render_memory(picture, picture.resolve_without_grid(), 0, input.memory_limit());

  const ThreadLimit threads(common.threads);
  PictureFrames source(input, conversion, picture, options.turntable);
  Sequence sequence(plan, options.sequence, input.memory_limit());
  SequenceReport report(common, source.verb(), plan.frames.size());
  Json more = Json::object();
  if (source.needs_settling()) {
    std::vector<int> seen;
    std::vector<std::string> unseen;
    const auto show = [&](int frame, const LoadedFrame& loaded) {
      source.see(loaded);
      seen.push_back(frame);
    };
    std::reverse(camera_frames.begin(), camera_frames.end()); // what is loaded last is kept for its turn
    const std::size_t wanted = camera_frames.size();
    if (options.camera_frames.empty()) // any other frame is better than none
      camera_frames.insert(camera_frames.end(), plan.frames.begin(), plan.frames.end());
    sequence.show(source, camera_frames, wanted, show, unseen);
    source.settle();
    std::reverse(seen.begin(), seen.end());
    if (plan.numbered && common.talks() && options.turntable == 0)
      print(fmt::format("camera{}: by {} {}, for all frames\n", picture.ground ? " and ground" : "",
                        seen.size() == 1 ? "frame" : "frames", frames_text(seen)));
    for (const std::string& problem : unseen) print_warning("no camera by " + problem);
    more["camera_frames"] = seen;
  }
  Json all_options = picture.json(source.options_of(plan.frames.front()), thread_count());
  all_options.update(input.json());
  all_options.update(conversion.json());
  all_options.update(options.json());
  more["options"] = all_options;
  render_source(source, sequence, report, options, more);
}

void render_source(const FrameSource& source, Sequence& sequence, SequenceReport& report,
                   const RenderFramesOptions& options, const Json& more) {
  const bool films = !options.movie.empty();
  if (films && !has_program("ffmpeg"))
    print_warning("--movie: there is no program ffmpeg in PATH; only the frames will be written");
  sequence.run(source, report);

  std::optional<Error> no_movie;
  const std::vector<int> failed = report.failed(), missing = report.missing();
  if (films && !(options.sequence.fail_fast && !failed.empty())) {
    std::vector<int> frames = sequence.plan().frames;
    std::sort(frames.begin(), frames.end());
    std::vector<std::string> pictures;
    for (const int frame : frames)
      if (std::count(failed.begin(), failed.end(), frame) +
              std::count(missing.begin(), missing.end(), frame) ==
          0)
        pictures.push_back(sequence.plan().outputs.front().path(frame));
    try {
      if (pictures.empty()) throw Error(ErrorKind::failed, options.movie + ": no movie: there are no frames");
      write_movie(options.movie_options(), pictures);
    } catch (const Error& error) {
      no_movie = error;
      if (!failed.empty()) print_error(error.what()); // the job ends with the failed frames
    }
    if (!no_movie && pictures.size() < frames.size())
      print_warning(options.movie + ": frames that are not there are not in the movie");
  }
  report.finish(more);
  if (no_movie) throw *no_movie;
}

} // namespace levelray
