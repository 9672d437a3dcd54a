#include "levelray/core/parallel.hpp"

#include "levelray/core/error.hpp"

#include <algorithm>
#include <csignal>
#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>

namespace levelray {

namespace {
volatile std::sig_atomic_t g_cancel = 0;
} // namespace

void parallel_for(std::size_t count, std::size_t grain,
                  const std::function<void(std::size_t, std::size_t)>& body) {
  grain = std::max<std::size_t>(grain, 1);
  const std::size_t chunks = (count + grain - 1) / grain;
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, chunks, 1),
      [&](const tbb::blocked_range<std::size_t>& range) {
        for (std::size_t chunk = range.begin(); chunk != range.end(); ++chunk) {
          check_cancel();
          body(chunk * grain, std::min(count, (chunk + 1) * grain));
        }
      },
      tbb::simple_partitioner());
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

void request_cancel() noexcept {
  g_cancel = 1;
}
bool cancel_requested() noexcept {
  return g_cancel != 0;
}
void check_cancel() {
  if (cancel_requested()) throw Cancelled();
}

} // namespace levelray
