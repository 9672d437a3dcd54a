#include "levelray/io/limited_process.hpp"

#include "levelray/core/parallel.hpp"

#include <cerrno>
#include <chrono>
#include <climits>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

extern char** environ;

namespace levelray {

namespace {

using Clock = std::chrono::steady_clock;

std::string find_reader(const ReaderProgram& program) {
  if (const char* given = std::getenv(program.variable); given && *given) return given;
  char buffer[PATH_MAX];
  const ssize_t length = ::readlink("/proc/self/exe", buffer, sizeof buffer);
  if (length > 0) {
    std::string folder(buffer, static_cast<std::size_t>(length));
    folder.resize(folder.rfind('/') + 1);
    for (const char* place : {"", "../libexec/levelray/", "../lib/levelray/", "../lib/", "../../lib/"}) {
      const std::string candidate = folder + place + program.name;
      if (::access(candidate.c_str(), X_OK) == 0) return candidate;
    }
  }
  const std::string installed = std::string(LEVELRAY_LIBEXECDIR "/") + program.name;
  if (::access(installed.c_str(), X_OK) == 0) return installed;
  throw Error(ErrorKind::failed, fmt::format("cannot find the program {} that reads {} safely; set {} to its "
                                             "path, or trust the input to read it without",
                                             program.name, program.reads, program.variable));
}

// A started reader; killed and waited for at the end of its life.
class Child {
 public:
  Child(const std::string& program, const std::vector<std::string>& arguments) {
    int ends[2];
    if (::pipe2(ends, O_CLOEXEC) != 0) fail(program, errno);
    read_end_ = ends[0];
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, ends[1], 1);
    posix_spawn_file_actions_addopen(&actions, 2, "/dev/null", O_WRONLY, 0);

    // A group of its own: Ctrl-C reaches the parent alone, which ends the child. No signal stays blocked.
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    sigset_t none, all;
    sigemptyset(&none);
    sigfillset(&all);
    posix_spawnattr_setsigmask(&attributes, &none);
    posix_spawnattr_setsigdefault(&attributes, &all);
    posix_spawnattr_setpgroup(&attributes, 0);
    posix_spawnattr_setflags(&attributes,
                             POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETPGROUP);

    std::vector<char*> argv{const_cast<char*>(program.c_str())};
    for (const std::string& a : arguments) argv.push_back(const_cast<char*>(a.c_str()));
    argv.push_back(nullptr);
    const int error = ::posix_spawn(&pid_, argv[0], &actions, &attributes, argv.data(), environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
    ::close(ends[1]);
    if (error) {
      pid_ = -1;
      ::close(read_end_);
      fail(program, error);
    }
  }
  ~Child() {
    if (pid_ >= 0) {
      ::kill(pid_, SIGKILL);
      wait();
    }
    ::close(read_end_);
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  int read_end() const { return read_end_; }

  // What waitpid says of its end (0 when nobody can tell).
  int wait() {
    if (pid_ < 0) return status_;
    while (::waitpid(pid_, &status_, 0) < 0)
      if (errno != EINTR) {
        status_ = 0;
        break;
      }
    pid_ = -1;
    return status_;
  }

 private:
  [[noreturn]] static void fail(const std::string& program, int error) {
    throw Error(ErrorKind::failed, fmt::format("cannot start {}: {}", program, std::strerror(error)));
  }
  pid_t pid_ = -1;
  int read_end_ = -1;
  int status_ = 0;
};

struct StreamEnded {}; // the child closed its end too early

} // namespace

void read_in_process(const ReaderProgram& program, const std::vector<std::string>& arguments,
                     const std::string& path, double timeout_seconds,
                     const std::function<void(const ByteSource&)>& receive) {
  const double seconds = std::min(std::max(timeout_seconds, 0.0), 1e6);
  Child child(find_reader(program), arguments);
  const auto deadline =
      Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
  const auto too_slow = [&] {
    return Error(ErrorKind::limit,
                 fmt::format("{}: reading took longer than {:.6g} s and was stopped", path, seconds));
  };

  const ByteSource read = [&](void* bytes, std::size_t count) {
    char* at = static_cast<char*>(bytes);
    while (count) {
      check_cancel();
      const auto left =
          std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now()).count();
      if (left < 0) throw too_slow();
      pollfd ready{child.read_end(), POLLIN, 0};
      const int changed = ::poll(&ready, 1, static_cast<int>(std::min<long long>(left + 1, 100)));
      if (changed == 0 || (changed < 0 && errno == EINTR)) continue;
      const ssize_t got = ::read(child.read_end(), at, count);
      if (got < 0 && errno == EINTR) continue;
      if (got <= 0) throw StreamEnded();
      at += got;
      count -= static_cast<std::size_t>(got);
    }
  };
  try {
    receive(read);
  } catch (const StreamEnded&) {
    const int status = child.wait();
    check_cancel();
    if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU) throw too_slow();
    if (WIFSIGNALED(status))
      throw Error(ErrorKind::bad_input,
                  fmt::format("{}: reader crashed (signal {}); the file is damaged or hostile", path,
                              WTERMSIG(status)));
    throw Error(ErrorKind::bad_input,
                fmt::format("{}: the reader ended without an answer (status {})", path, WEXITSTATUS(status)));
  }
}

void check_first_bytes(const std::string& path, std::string_view magic, const std::string& kind) {
  const auto fail = [&](const std::string& reason) {
    throw Error(ErrorKind::bad_input, path + ": " + reason);
  };
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (status.type() == std::filesystem::file_type::not_found) fail("no such file");
  if (status.type() == std::filesystem::file_type::directory) fail("is a directory");
  if (status.type() != std::filesystem::file_type::regular) fail("is not a regular file");
  std::ifstream stream(path, std::ios::binary);
  if (!stream) fail(std::string("cannot be opened: ") + std::strerror(errno));
  std::string head(magic.size(), '\0');
  stream.read(head.data(), static_cast<std::streamsize>(head.size()));
  if (stream.gcount() == 0) fail("empty file");
  if (head != magic) fail("not " + kind);
}

} // namespace levelray
