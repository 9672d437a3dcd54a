#include "sequence.hpp"

#include "input.hpp"
#include "levelray/core/content_hash.hpp"
#include "levelray/core/error.hpp"
#include "levelray/core/parallel.hpp"
#include "levelray/io/exr_writer.hpp"
#include "levelray/io/output_file.hpp"
#include "levelray/io/scene_stamp.hpp"

#include <fmt/format.h>
#include <future>
#include <new>
#include <set>

namespace levelray {

namespace {

// What a failure is called in the frame's line.
struct Failure {
  std::string text;
  ErrorKind kind;
};

// Runs work of one frame. What ends the whole job passes through: Cancelled, OutputGone, failing outputs.
template <class F>
std::optional<Failure> failure_of(const F& work, double timeout) {
  try {
    work();
    return std::nullopt;
  } catch (const Error& error) {
    if (error.kind() == ErrorKind::cannot_write) throw;
    return Failure{error.what(), error.kind()};
  } catch (const TimeUp&) {
    return Failure{fmt::format("took longer than --frame-timeout {:g}", timeout), ErrorKind::limit};
  } catch (const std::bad_alloc&) {
    return Failure{"out of memory; try coarser voxels or a smaller picture", ErrorKind::limit};
  }
}

void fail(FrameResult& result, const Failure& failure) {
  result.status = FrameResult::Status::failed;
  result.error = failure.text;
  result.exit_code = static_cast<int>(failure.kind);
}

std::string scene_hash(const FrameSource& source, int frame, const std::string& content) {
  const std::string text =
      fmt::format("levelray {}\nOpenEXR {}\nframe {}\n{}{}\n{}", LEVELRAY_VERSION, openexr_version(), frame,
                  content, source.verb(), source.settings(frame));
  ContentHash hash;
  hash.add(text.data(), text.size());
  return hash.uuid();
}

// Waits for another thread's work, noticing signals.
template <class T>
T wait(std::future<T>& future) {
  while (future.wait_for(std::chrono::milliseconds(20)) != std::future_status::ready) check_cancel();
  return future.get();
}

} // namespace

// What another thread finds out about a frame before its turn.
struct Sequence::Prepared {
  FrameResult result;
  std::string hash;
  std::shared_ptr<const LoadedFrame> loaded; // when the frame has to be made
  double seconds = 0;                        // that loading took
  bool try_alone = false;                    // did not fit beside the frame before
};

Sequence::Sequence(FramePlan plan, const SequenceOptions& options, std::uint64_t memory_limit)
    : plan_(std::move(plan)), options_(options), memory_limit_(memory_limit),
      inputs_(plan_.inputs, options.missing) {}

std::uint64_t Sequence::all_memory(const FrameSource& source) const {
  return memory_limit_ - std::min(memory_limit_ - 1, source.making_bytes());
}

std::shared_ptr<const LoadedFrame> Sequence::load(const FrameSource& source, const FrameInputs::Found& inputs,
                                                  std::uint64_t memory) {
  if (kept_ && kept_content_ == inputs.content) return kept_;
  kept_.reset();
  const TimeLimit limit(options_.frame_timeout);
  std::shared_ptr<const LoadedFrame> loaded = source.load(inputs.paths, memory, limit.left());
  inputs_.check_unchanged(inputs);
  kept_content_ = inputs.content;
  return kept_ = std::move(loaded);
}

void Sequence::show(const FrameSource& source, const std::vector<int>& frames, std::size_t wanted,
                    const std::function<void(int, const LoadedFrame&)>& shown,
                    std::vector<std::string>& problems) {
  std::optional<Failure> first;
  std::set<int> tried;
  bool any = false;
  for (std::size_t i = 0; i < frames.size() && (i < wanted || !any); ++i) {
    if (!tried.insert(frames[i]).second) continue;
    const std::optional<Failure> failure = failure_of(
        [&] {
          const FrameInputs::Found inputs = inputs_.find(frames[i]);
          if (!inputs.missing.empty()) throw Error(ErrorKind::bad_input, inputs.missing);
          shown(frames[i], *load(source, inputs, all_memory(source)));
        },
        options_.frame_timeout);
    any |= !failure;
    if (failure) problems.push_back(fmt::format("frame {}: {}", frames[i], failure->text));
    if (failure && !first) first = failure;
  }
  if (!any)
    throw Error(first->kind,
                fmt::format("none of {} frames can be read; first: {}", tried.size(), first->text));
}

void Sequence::prepare_or_throw(const FrameSource& source, std::uint64_t memory, Prepared& prepared) {
  FrameResult& result = prepared.result;
  const Stopwatch watch;
  const FrameInputs::Found inputs = inputs_.find(result.frame);
  result.inputs = inputs.paths;
  if (!inputs.missing.empty()) {
    result.status = options_.missing == "skip" ? FrameResult::Status::missing : FrameResult::Status::failed;
    result.error = inputs.missing;
    result.exit_code = options_.missing == "skip" ? 0 : static_cast<int>(ErrorKind::bad_input);
    return;
  }
  if (inputs.held) result.facts["held"] = true;
  prepared.hash = scene_hash(source, result.frame, inputs.content);
  result.facts["scene_hash"] = prepared.hash;
  if (options_.skip_existing) {
    std::string reason;
    for (const std::string& output : result.outputs)
      if (reason.empty()) reason = distrust(output, prepared.hash);
    if (reason.empty()) {
      for (const std::string& output : result.outputs) remove_stale_temporary_files(output);
      result.status = FrameResult::Status::skipped;
      return;
    }
    result.facts["why"] = reason;
  }
  prepared.loaded = load(source, inputs, memory);
  result.warnings = prepared.loaded->warnings;
  prepared.seconds = watch.ms() / 1000;
  result.facts["ms"]["load"] = watch.ms();
}

Sequence::Prepared Sequence::prepare(const FrameSource& source, int frame, std::uint64_t memory) {
  Prepared prepared;
  prepared.result.frame = frame;
  prepared.result.outputs = plan_.output_paths(frame);
  const auto failure =
      failure_of([&] { prepare_or_throw(source, memory, prepared); }, options_.frame_timeout);
  if (failure) fail(prepared.result, *failure);
  prepared.try_alone = failure && failure->kind == ErrorKind::limit && memory < all_memory(source);
  return prepared;
}

void Sequence::run(const FrameSource& source, SequenceReport& report) {
  const std::vector<int>& frames = plan_.frames;
  const std::uint64_t all = all_memory(source);
  std::future<Prepared> loading; // the next frame
  std::future<void> writing;     // the frame before
  std::uint64_t written_bytes = 0;
  const auto load_in_background = [&](std::size_t i, std::uint64_t used) {
    if (i < frames.size())
      loading = std::async(std::launch::async, [this, &source, frame = frames[i], all, used] {
        return prepare(source, frame, all - std::min(all - 1, used));
      });
  };
  const auto finish_writing = [&] {
    if (writing.valid()) wait(writing);
    written_bytes = 0;
  };

  try {
    report.progress(0);
    load_in_background(0, 0);
    for (std::size_t i = 0; i < frames.size(); ++i) {
      Prepared prepared = wait(loading);
      if (prepared.try_alone) {
        finish_writing();
        prepared = prepare(source, frames[i], all);
      }
      const std::shared_ptr<const LoadedFrame> loaded = std::move(prepared.loaded);
      const std::uint64_t used = source.making_bytes() + (loaded ? loaded->bytes : 0);
      load_in_background(i + 1, (loaded ? loaded->bytes : 0) + written_bytes);

      FrameResult& result = prepared.result;
      std::shared_ptr<MadeFrame> made;
      const Stopwatch watch;
      if (loaded) {
        const auto failure = failure_of(
            [&] {
              if (used > memory_limit_)
                throw Error(ErrorKind::limit, fmt::format("needs {}, --max-memory is {}", bytes_text(used),
                                                          bytes_text(memory_limit_)));
              const TimeLimit limit(
                  options_.frame_timeout > 0 ? std::max(options_.frame_timeout - prepared.seconds, 1e-3) : 0);
              made = std::make_shared<MadeFrame>(source.make(frames[i], loaded, result.outputs,
                                                             [&](double done) { report.progress(done); }));
            },
            options_.frame_timeout);
        if (failure) fail(result, *failure);
      }
      finish_writing();
      if (made) {
        result.warnings.insert(result.warnings.end(), made->warnings.begin(), made->warnings.end());
        written_bytes = made->bytes;
        writing =
            std::async(std::launch::async, [&report, made, result, watch, hash = prepared.hash]() mutable {
              const Stopwatch write;
              if (const auto failure = failure_of([&] { made->write(hash); }, 0)) fail(result, *failure);
              for (const auto& [key, value] : made->facts.items()) {
                if (key != "ms")
                  result.facts[key] = value;
                else
                  result.facts["ms"].update(value);
              }
              result.facts["ms"]["write"] = write.ms();
              result.seconds = watch.ms() / 1000;
              report.add(result);
            });
      } else {
        report.add(result);
      }
      if (options_.fail_fast && !report.failed().empty()) break;
    }
    finish_writing();
  } catch (const Cancelled&) {
    report.stopped();
    throw;
  } catch (...) {
    request_cancel(); // nothing will be made of the frame that is loading
    throw;
  }
}

} // namespace levelray
