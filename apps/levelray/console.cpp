#include "console.hpp"

#include "levelray/core/error.hpp"

#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fmt/format.h>
#include <unistd.h>

namespace levelray {

namespace {

bool g_output_closed = false;

void print_diagnostic(const std::string& prefix, const std::string& message) {
  // Error's messages have at most 480 bytes; the prefix and others' messages are held to 500 here.
  const std::string line = prefix + printable(message, 499 - prefix.size()) + "\n";
  std::fwrite(line.data(), 1, line.size(), stderr);
}

} // namespace

void set_output_closed() {
  g_output_closed = true;
}

void print(const std::string& text) {
  errno = 0;
  const bool written = !g_output_closed && std::fwrite(text.data(), 1, text.size(), stdout) == text.size() &&
                       std::fflush(stdout) == 0;
  if (written) return;
  if (errno == EPIPE) throw OutputGone();
  throw Error(ErrorKind::cannot_write, std::string("standard output: cannot write: ") +
                                           (g_output_closed ? "closed" : std::strerror(errno)));
}

void print_warning(const std::string& message) {
  print_diagnostic("levelray: warning: ", message);
}
void print_error(const std::string& message) {
  print_diagnostic("levelray: ", message);
}

std::string with_commas(std::uint64_t n) {
  std::string digits = std::to_string(n);
  for (std::ptrdiff_t at = static_cast<std::ptrdiff_t>(digits.size()) - 3; at > 0; at -= 3)
    digits.insert(static_cast<std::size_t>(at), 1, ',');
  return digits;
}

std::string counted(std::uint64_t n, const std::string& one, const std::string& many) {
  return with_commas(n) + " " + (n == 1 ? one : many);
}

std::string si_text(double value) {
  constexpr const char* prefixes[] = {"", "k", "M", "G", "T"};
  std::size_t prefix = 0;
  for (; value >= 999.5 && prefix < 4; ++prefix) value /= 1000;
  // Two significant digits at least; counts below a thousand have no fraction.
  const int decimals = value < 9.95 && prefix > 0 ? 1 : 0;
  return fmt::format("{:.{}f}{}{}", value, decimals, prefix > 0 ? " " : "", prefixes[prefix]);
}

std::string bytes_text(std::uint64_t bytes) {
  const std::string text = si_text(static_cast<double>(bytes));
  return text + (text.find(' ') == std::string::npos ? " B" : "B");
}

std::string duration_text(double seconds) {
  if (!(seconds >= 0)) return "?";
  if (seconds < 59.95) return fmt::format("{:.{}f} s", seconds, seconds < 0.995 ? 2 : 1);
  if (seconds > 1e9) return "years";
  const auto whole = static_cast<std::int64_t>(std::lround(seconds));
  if (whole < 3600) return fmt::format("{}:{:02}", whole / 60, whole % 60);
  return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
}

Progress::Progress(bool quiet)
    : shown_(!quiet && ::isatty(STDERR_FILENO) &&
             std::string_view(std::getenv("TERM") ? std::getenv("TERM") : "dumb") != "dumb") {}

void Progress::begin(const std::string& stage, double amount, const std::string& unit) {
  if (!shown_) return;
  const std::lock_guard lock(mutex_);
  stage_ = stage;
  unit_ = unit;
  amount_ = amount;
  start_ = Clock::now();
  next_report_ = start_.time_since_epoch().count() + 200'000'000; // nothing about work that is soon over
}

void Progress::report(double done) {
  if (!shown_) return;
  const auto now = Clock::now();
  std::int64_t due = next_report_;
  if (now.time_since_epoch().count() < due ||
      !next_report_.compare_exchange_strong(due, now.time_since_epoch().count() + 100'000'000))
    return;
  const std::lock_guard lock(mutex_);
  const double elapsed = std::chrono::duration<double>(now - start_).count();
  std::string line = fmt::format("\r{} {:3.0f}%", stage_, 100 * done);
  if (amount_ > 0 && elapsed > 0) line += fmt::format("  {}{}/s", si_text(amount_ * done / elapsed), unit_);
  if (done > 0) line += fmt::format("  {} left", duration_text(elapsed * (1 - done) / done));
  line += "\033[K";
  std::fwrite(line.data(), 1, line.size(), stderr);
  std::fflush(stderr);
  line_is_dirty_ = true;
}

void Progress::show(const std::string& line) {
  if (!shown_) return;
  const std::int64_t now = Clock::now().time_since_epoch().count();
  std::int64_t due = next_report_;
  if (now < due || !next_report_.compare_exchange_strong(due, now + 100'000'000)) return;
  const std::lock_guard lock(mutex_);
  const std::string text = "\r" + line + "\033[K";
  std::fwrite(text.data(), 1, text.size(), stderr);
  std::fflush(stderr);
  line_is_dirty_ = true;
}

void Progress::finish() {
  const std::lock_guard lock(mutex_);
  if (line_is_dirty_) std::fputs("\r\033[K", stderr);
  line_is_dirty_ = false;
}

} // namespace levelray
