#include "levelray/core/parallel.hpp"

#include "levelray/core/error.hpp"

#include <algorithm>
#include <atomic>
#include <limits>
#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <tbb/version.h>

namespace levelray {

namespace {

std::atomic<bool> g_cancel{false};
static_assert(std::atomic<bool>::is_always_lock_free); // so that signal handlers may set it

using Clock = std::chrono::steady_clock;
constexpr Clock::time_point never = Clock::time_point::max();
thread_local Clock::time_point t_end = never;

// A loop's chunk in some worker has the time limit of the thread that began the loop.
class InheritedLimit {
 public:
  explicit InheritedLimit(Clock::time_point end) : own_(t_end) { t_end = end; }
  ~InheritedLimit() { t_end = own_; }
  InheritedLimit(const InheritedLimit&) = delete;
  InheritedLimit& operator=(const InheritedLimit&) = delete;

 private:
  Clock::time_point own_;
};

// What TBB's queues guarantee, told to the thread sanitizer, which does not see into libtbb: all before a
// publish(tag) happens before all after an observe(tag). In its builds this file alone is not instrumented
// (lib/CMakeLists.txt); the loops' bodies are.
#ifdef LEVELRAY_THREAD_SANITIZER
extern "C" void __tsan_release(void* tag);
extern "C" void __tsan_acquire(void* tag);
void publish(char& tag) {
  __tsan_release(&tag);
}
void observe(char& tag) {
  __tsan_acquire(&tag);
}
#else
void publish(char&) {}
void observe(char&) {}
#endif
// At the end of a scope, exceptions included: one that a chunk throws is freed by who began the loop.
struct PublishAtEnd {
  char& tag;
  ~PublishAtEnd() { publish(tag); }
};
struct ObserveAtEnd {
  char& tag;
  ~ObserveAtEnd() { observe(tag); }
};

} // namespace

void parallel_for(std::size_t count, std::size_t grain,
                  const std::function<void(std::size_t, std::size_t)>& body) {
  grain = std::max<std::size_t>(grain, 1);
  const std::size_t chunks = (count + grain - 1) / grain;
  char begun = 0, done = 0;
  const Clock::time_point end = t_end;
  publish(begun);
  const ObserveAtEnd all_done{done};
  const auto loop = [&] {
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, chunks, 1),
        [&](const tbb::blocked_range<std::size_t>& range) {
          observe(begun);
          const PublishAtEnd chunks_done{done};
          const InheritedLimit limit(end);
          for (std::size_t chunk = range.begin(); chunk != range.end(); ++chunk) {
            check_cancel();
            body(chunk * grain, std::min(count, (chunk + 1) * grain));
          }
        },
        tbb::simple_partitioner());
  };
  // TBB's own arena has a place per core: more threads than that, when asked for, need one of their own.
  const int threads = thread_count();
  if (threads > tbb::info::default_concurrency())
    tbb::task_arena(threads).execute(loop);
  else
    loop();
}

struct ThreadLimit::Impl {
  tbb::global_control control;
};

ThreadLimit::ThreadLimit(int threads)
    : impl_(new Impl{tbb::global_control(
          tbb::global_control::max_allowed_parallelism,
          static_cast<std::size_t>(threads > 0 ? threads : tbb::info::default_concurrency()))}) {}

ThreadLimit::~ThreadLimit() = default;

int thread_count() {
  return static_cast<int>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
}

const char* tbb_version() {
  return TBB_VERSION_STRING;
}

void request_cancel() noexcept {
  g_cancel.store(true, std::memory_order_relaxed);
}
bool cancel_requested() noexcept {
  return g_cancel.load(std::memory_order_relaxed);
}
void check_cancel() {
  if (cancel_requested()) throw Cancelled();
  if (t_end != never && Clock::now() > t_end) throw TimeUp();
}

TimeLimit::TimeLimit(double seconds) : end_(never) {
  if (seconds > 0 && seconds < 1e9)
    end_ = Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
  t_end = end_;
}
TimeLimit::~TimeLimit() {
  t_end = never;
}
double TimeLimit::left() const {
  if (end_ == never) return std::numeric_limits<double>::infinity();
  return std::max(0.0, std::chrono::duration<double>(end_ - Clock::now()).count());
}

} // namespace levelray
