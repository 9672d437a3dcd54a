#include "signals.hpp"

#include "levelray/core/parallel.hpp"
#include "levelray/io/output_file.hpp"

#include <cerrno>
#include <csignal>
#include <fcntl.h>
#include <sys/time.h>
#include <unistd.h>

namespace levelray {

namespace {

volatile std::sig_atomic_t g_signal = 0;

[[noreturn]] void end_now() {
  remove_temporary_files();
  ::_exit(128 + g_signal);
}

void on_stop(int signal) {
  if (g_signal != 0) end_now();
  g_signal = signal;
  const int saved_errno = errno;
  request_cancel();
  itimerval timer = {};
  timer.it_value.tv_usec = 250000; // half a second is promised, and a large process takes its time to end
  ::setitimer(ITIMER_REAL, &timer, nullptr);
  errno = saved_errno;
}

void on_alarm(int) {
  if (g_signal != 0) end_now();
}

void install(int signal, void (*handler)(int)) {
  struct sigaction action = {};
  action.sa_handler = handler;
  action.sa_flags = SA_RESTART; // reads and writes go on until the work itself notices
  ::sigemptyset(&action.sa_mask);
  ::sigaction(signal, &action, nullptr);
}

} // namespace

void handle_signals() {
  // A signal that was ignored by the caller (nohup) stays ignored.
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction old = {};
    ::sigaction(signal, nullptr, &old);
    if (old.sa_handler != SIG_IGN) install(signal, on_stop);
  }
  install(SIGALRM, on_alarm);
  install(SIGPIPE, SIG_IGN);
  install(SIGXFSZ, SIG_IGN);
}

int stop_signal() {
  return g_signal;
}

void die_of_broken_pipe() {
  remove_temporary_files();
  install(SIGPIPE, SIG_DFL);
  ::raise(SIGPIPE);
  ::_exit(128 + SIGPIPE);
}

bool reserve_standard_streams() {
  bool output_was_closed = false;
  for (const int stream : {0, 1, 2})
    if (::fcntl(stream, F_GETFD) == -1 && errno == EBADF) {
      // The lowest free number is the one that is missing.
      [[maybe_unused]] const int file = ::open("/dev/null", O_RDWR);
      output_was_closed = output_was_closed || stream == 1;
    }
  return output_was_closed;
}

} // namespace levelray
