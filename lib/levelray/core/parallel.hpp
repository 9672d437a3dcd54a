// Parallel loops and cancellation: the only door to TBB.
//
// Work is cut into chunks that depend on `count` and `grain` alone, never on the number of threads, so that a
// loop whose chunks write to places of their own gives the same bytes on any machine.
#pragma once

#include <chrono>
#include <cstddef>
#include <exception>
#include <functional>
#include <memory>

namespace levelray {

// Calls body(begin, end) for consecutive index ranges that cover [0, count), each at most `grain` long, on
// all allowed threads. Throws Cancelled when `request_cancel()` was called before the last chunk began; the
// first exception of a body is rethrown.
void parallel_for(std::size_t count, std::size_t grain,
                  const std::function<void(std::size_t begin, std::size_t end)>& body);

// Limits the threads of all parallel loops while it lives; 0 means all the hardware's.
class ThreadLimit {
 public:
  explicit ThreadLimit(int threads);
  ~ThreadLimit();
  ThreadLimit(const ThreadLimit&) = delete;
  ThreadLimit& operator=(const ThreadLimit&) = delete;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// The number of threads that parallel loops use now.
int thread_count();

// The version of the library beneath, e.g. "2021.8".
const char* tbb_version();

// Asks running and later work to stop; async-signal-safe. Loops notice between chunks, serial stages by
// `check_cancel()`.
void request_cancel() noexcept;
bool cancel_requested() noexcept;
// Throws Cancelled when a stop was asked for, TimeUp when the thread's TimeLimit is over.
void check_cancel();

// What work throws that a TimeLimit ended.
class TimeUp : public std::exception {
 public:
  const char* what() const noexcept override { return "took longer than its time limit"; }
};

// Limits the time of the work that this thread does while it lives, and of the parallel loops that it starts:
// they throw TimeUp where they would notice a cancellation. Does not nest; ends in the thread that made it.
class TimeLimit {
 public:
  explicit TimeLimit(double seconds); // 0: none
  ~TimeLimit();
  TimeLimit(const TimeLimit&) = delete;
  TimeLimit& operator=(const TimeLimit&) = delete;

  double left() const; // seconds, at least 0; infinite without a limit

 private:
  std::chrono::steady_clock::time_point end_;
};

} // namespace levelray
