// Runs the levelray program as a user does, and keeps what it said.
#pragma once

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <functional>
#include <linux/capability.h>
#include <poll.h>
#include <stdexcept>
#include <string>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>
#include <vector>

namespace levelray::test {

// From a signal to the end of the program.
// Half a second is the promise. The thread sanitizer hands a signal on only when the program calls into it,
// which a loop of arithmetic does not: with it the tests ask for an end, not for its time.
#ifdef __SANITIZE_THREAD__
constexpr double promised_seconds = 30;
#else
constexpr double promised_seconds = 0.5;
#endif

struct RunResult {
  int code = -1; // exit code, or 128 + the signal that ended it
  bool signalled = false;
  std::string out, err;
  double seconds_after_signal = 0; // from the last signal sent to the end
};

struct RunOptions {
  std::function<void()> in_child;              // between fork and exec: limits, closed streams
  std::vector<std::pair<double, int>> signals; // (seconds after the start, signal)
  std::vector<std::string> under;              // a program that runs ours, e.g. {"fiu-run", "-x"}
};

// For RunOptions::in_child: takes from root the right to write where permissions forbid it. Root stays the
// owner of its files and may run programs in its own folders, which another user might not.
inline void obey_permissions() {
  if (::geteuid() == 0 && ::prctl(PR_CAPBSET_DROP, CAP_DAC_OVERRIDE, 0, 0, 0) != 0) ::_exit(125);
}

// Runs LEVELRAY_PROGRAM with these arguments; standard input is empty.
inline RunResult run_program(const std::vector<std::string>& arguments, const RunOptions& options = {}) {
  int out[2], err[2];
  if (::pipe2(out, O_CLOEXEC) != 0 || ::pipe2(err, O_CLOEXEC) != 0) throw std::runtime_error("no pipes");
  std::vector<char*> argv;
  for (const std::string& a : options.under) argv.push_back(const_cast<char*>(a.c_str()));
  argv.push_back(const_cast<char*>(options.under.empty() ? "levelray" : LEVELRAY_PROGRAM));
  for (const std::string& a : arguments) argv.push_back(const_cast<char*>(a.c_str()));
  argv.push_back(nullptr);

  const auto start = std::chrono::steady_clock::now();
  const auto seconds = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  const pid_t child = ::fork();
  if (child < 0) throw std::runtime_error("no process");
  if (child == 0) {
    ::dup2(::open("/dev/null", O_RDONLY), 0);
    ::dup2(out[1], 1);
    ::dup2(err[1], 2);
    if (options.in_child) options.in_child();
    if (options.under.empty())
      ::execv(LEVELRAY_PROGRAM, argv.data());
    else
      ::execvp(argv[0], argv.data());
    ::_exit(127);
  }
  ::close(out[1]);
  ::close(err[1]);

  RunResult result;
  std::size_t next_signal = 0;
  double last_signal = 0;
  pollfd streams[2] = {{out[0], POLLIN, 0}, {err[0], POLLIN, 0}};
  for (int open = 2; open > 0;) {
    int wait_ms = -1;
    if (next_signal < options.signals.size()) {
      const double left = options.signals[next_signal].first - seconds();
      if (left <= 0) {
        ::kill(child, options.signals[next_signal++].second);
        last_signal = seconds();
        continue;
      }
      wait_ms = static_cast<int>(left * 1000) + 1;
    }
    if (::poll(streams, 2, wait_ms) < 0 && errno != EINTR) break;
    for (int i = 0; i < 2; ++i) {
      if (streams[i].fd < 0 || streams[i].revents == 0) continue;
      char bytes[4096];
      const ssize_t n = ::read(streams[i].fd, bytes, sizeof bytes);
      if (n > 0)
        (i == 0 ? result.out : result.err).append(bytes, static_cast<std::size_t>(n));
      else {
        streams[i].fd = -1;
        --open;
      }
    }
  }
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  result.seconds_after_signal = seconds() - last_signal;
  ::close(out[0]);
  ::close(err[0]);
  result.signalled = WIFSIGNALED(status);
  result.code = result.signalled ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
  return result;
}

// Whether there is a program of that name in PATH.
inline bool has_tool(const std::string& name) {
  return std::system(("command -v " + name + " >/dev/null 2>&1").c_str()) == 0;
}

} // namespace levelray::test
