#include "sequence_report.hpp"

#include "levelray/core/error.hpp"
#include "levelray/io/frame_list.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

namespace levelray {

namespace {

constexpr std::size_t most_warnings = 20; // on standard error

std::string frame_count(std::size_t n) {
  return counted(n, "frame", "frames");
}

std::vector<int> sorted(std::vector<int> frames) {
  std::sort(frames.begin(), frames.end());
  return frames;
}

} // namespace

std::string sequence_progress_text(std::size_t done, double made, std::size_t all, double seconds) {
  std::string text = fmt::format("frame {}/{}  {:.0f}%", std::min(done + 1, all), all,
                                 std::floor(100 * static_cast<double>(done) / static_cast<double>(all)));
  if (made > 0 && seconds > 0) {
    const double per_frame = seconds / made;
    // The fraction that the frame in work has come is in `made` but not in `done`.
    const double left = std::max(0.0, static_cast<double>(all - done) - (made - std::floor(made)));
    text += fmt::format("  {:.3g} frames/min  {} left", 60 / per_frame, duration_text(left * per_frame));
  }
  return text;
}

SequenceReport::SequenceReport(const CommonOptions& common, const char* verb, std::size_t frames)
    : common_(common), verb_(verb), all_(frames), progress_(common.quiet) {
  if (common.json.empty() || common.json == "-") return;
  json_file_ = ::open(common.json.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_APPEND | O_CLOEXEC, 0666);
  if (json_file_ < 0)
    throw Error(ErrorKind::cannot_write,
                printable(common.json, 300) + ": cannot write: " + std::strerror(errno));
}

SequenceReport::~SequenceReport() {
  if (json_file_ >= 0) ::close(json_file_);
}

double SequenceReport::seconds() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

void SequenceReport::line(const Json& json) {
  if (common_.json.empty()) return;
  const std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
  if (common_.json == "-") return print(text);
  for (std::size_t at = 0; at < text.size();) {
    const ssize_t written = ::write(json_file_, text.data() + at, text.size() - at);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0)
      throw Error(ErrorKind::cannot_write,
                  printable(common_.json, 300) + ": cannot write: " + std::strerror(errno));
    at += static_cast<std::size_t>(written);
  }
}

void SequenceReport::add(const FrameResult& result) {
  using Status = FrameResult::Status;
  const std::lock_guard lock(mutex_);
  progress_.finish();
  const std::string name = fmt::format("frame {}: ", result.frame);
  for (const std::string& warning : result.warnings)
    if (warnings_.size() < most_warnings && warnings_.insert(warning).second) {
      print_warning(name + warning);
      if (warnings_.size() == most_warnings)
        print_warning("there are more warnings; --json tells all of them");
    }

  std::string status = verb_;
  switch (result.status) {
  case Status::made:
    ++made_;
    if (common_.talks())
      print(fmt::format("{}wrote {}, {}\n", name,
                        printable(fmt::format("{}", fmt::join(result.outputs, ", ")), 600),
                        duration_text(result.seconds)));
    break;
  case Status::skipped:
    ++skipped_;
    idle_seconds_ = made_ == 0 ? seconds() : idle_seconds_;
    status = "skipped";
    break;
  case Status::missing:
    missing_.push_back(result.frame);
    status = "missing";
    print_warning(name + result.error + "; skipped");
    break;
  case Status::failed:
    failed_.push_back(result.frame);
    if (first_failure_.empty()) first_failure_ = result.error;
    status = "failed";
    print_error(name + result.error);
    break;
  }
  Json json{{"frame", result.frame}, {"status", status}};
  if (!result.error.empty()) json["error"] = result.error;
  if (result.exit_code != 0) json["exit_code"] = result.exit_code;
  json["input"] = result.inputs;
  json["output"] = result.outputs;
  json.update(result.facts);
  json["warnings"] = result.warnings;
  line(json);
}

void SequenceReport::progress(double fraction) {
  if (!progress_.shown()) return;
  const std::lock_guard lock(mutex_);
  progress_.show(sequence_progress_text(made_ + skipped_ + missing_.size() + failed_.size(),
                                        static_cast<double>(made_) + std::min(fraction, 0.999), all_,
                                        seconds() - idle_seconds_));
}

std::string SequenceReport::counts() const {
  std::string text = fmt::format("{} {}", made_, verb_);
  if (skipped_ > 0) text += fmt::format(", {} skipped (already there)", skipped_);
  if (!missing_.empty()) text += fmt::format(", {} missing", missing_.size());
  if (!failed_.empty()) text += fmt::format(", {} failed", failed_.size());
  return text;
}

void SequenceReport::finish(const Json& more) {
  const std::lock_guard lock(mutex_);
  progress_.finish();
  const double all_seconds = seconds(), work = all_seconds - idle_seconds_;
  const double per_minute = work > 0 ? 60 * static_cast<double>(made_) / work : 0;
  if (common_.talks())
    print(fmt::format("{}: {}; {}{}\n", frame_count(all_), counts(), duration_text(all_seconds),
                      made_ > 0 ? fmt::format(", {:.3g} frames/min", per_minute) : ""));
  rusage usage = {};
  ::getrusage(RUSAGE_SELF, &usage);
  Json json{{"summary",
             {{"frames", all_},
              {verb_, made_},
              {"skipped", skipped_},
              {"missing", sorted(missing_)},
              {"failed", sorted(failed_)},
              {"seconds", all_seconds},
              {"frames_per_minute", per_minute},
              {"peak_memory", static_cast<std::uint64_t>(usage.ru_maxrss) * 1024}}}};
  json.update(more);
  line(json);
  if (!failed_.empty())
    throw Error(ErrorKind::some_frames,
                fmt::format("{} of {} failed: {}; first: {}", failed_.size(), frame_count(all_),
                            frames_text(sorted(failed_)), first_failure_));
}

void SequenceReport::stopped() {
  const std::lock_guard lock(mutex_);
  progress_.finish();
  print_error(fmt::format("stopped after {} of {}: {}", made_ + skipped_ + missing_.size() + failed_.size(),
                          frame_count(all_), counts()));
}

std::vector<int> SequenceReport::missing() const {
  const std::lock_guard lock(mutex_);
  return missing_;
}

std::vector<int> SequenceReport::failed() const {
  const std::lock_guard lock(mutex_);
  return failed_;
}

} // namespace levelray
