// What the user sees: results on standard output, warnings and errors on standard error, progress on a
// terminal.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <string>

namespace levelray {

// Standard output was a pipe whose reader went away.
struct OutputGone {};

// Tells that the caller closed standard output: every print to it then fails.
void set_output_closed();

// Prints to standard output, at once. Throws Error(cannot_write), or OutputGone.
void print(const std::string& text);

// "levelray: warning: ..." and "levelray: ..." as one line of at most 500 bytes on standard error.
void print_warning(const std::string& message);
void print_error(const std::string& message);

// "1,234,567"
std::string with_commas(std::uint64_t n);
// "1 hole", "1,234 holes"
std::string counted(std::uint64_t n, const std::string& one, const std::string& many);
// "9.8 MB"
std::string bytes_text(std::uint64_t bytes);
// "0.02 s", "1.4 s", "2:05", "1:02:03"
std::string duration_text(double seconds);
// "1.2 M", of a count or rate
std::string si_text(double value);

// A line on standard error that says how far work has come, how fast, and how long it will take. Only on
// terminals, at most ten times a second; wiped when the work is done. Reports may come from any thread.
class Progress {
 public:
  explicit Progress(bool quiet);
  ~Progress() { finish(); }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  // Begins a stage of `amount` things called `unit` ("rays"); amount 0: no rate is shown.
  void begin(const std::string& stage, double amount, const std::string& unit);
  void report(double done); // in [0,1]
  // Shows a line of the caller's instead.
  void show(const std::string& line);
  bool shown() const { return shown_; }
  void finish();

 private:
  using Clock = std::chrono::steady_clock;

  const bool shown_;
  std::mutex mutex_;
  std::string stage_, unit_;
  double amount_ = 0;
  bool line_is_dirty_ = false;
  Clock::time_point start_;
  std::atomic<std::int64_t> next_report_{0}; // nanoseconds of the clock
};

} // namespace levelray
