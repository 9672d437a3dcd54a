#include "movie.hpp"

#include "levelray/core/error.hpp"
#include "levelray/core/parallel.hpp"
#include "levelray/io/output_file.hpp"
#include "levelray/io/picture_reader.hpp"
#include "options.hpp"

#include <cerrno>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <optional>
#include <spawn.h>
#include <sstream>
#include <sys/wait.h>
#include <unistd.h>

extern char** environ;

namespace levelray {

namespace {

// A running ffmpeg that reads raw frames from us; killed at the end of its life unless it has finished.
class Ffmpeg {
 public:
  explicit Ffmpeg(const std::vector<std::string>& arguments) {
    int frames[2], words[2];
    if (::pipe2(frames, O_CLOEXEC) != 0 || ::pipe2(words, O_CLOEXEC) != 0) fail(std::strerror(errno));
    input_ = frames[1];
    words_ = words[0];
    ::fcntl(words_, F_SETFL, O_NONBLOCK);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, frames[0], 0);
    posix_spawn_file_actions_addopen(&actions, 1, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, words[1], 2);
    // A group of its own: Ctrl-C reaches us alone. No signal stays ignored.
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    sigset_t all;
    sigfillset(&all);
    posix_spawnattr_setsigdefault(&attributes, &all);
    posix_spawnattr_setpgroup(&attributes, 0);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETPGROUP);
    std::vector<char*> argv;
    for (const std::string& a : arguments) argv.push_back(const_cast<char*>(a.c_str()));
    argv.push_back(nullptr);
    const int error = ::posix_spawnp(&process_, argv[0], &actions, &attributes, argv.data(), environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
    ::close(frames[0]);
    ::close(words[1]);
    if (error != 0) {
      process_ = -1;
      fail(std::strerror(error));
    }
  }
  ~Ffmpeg() {
    if (process_ > 0) {
      ::kill(process_, SIGKILL);
      wait();
    }
    if (input_ >= 0) ::close(input_);
    ::close(words_);
  }
  Ffmpeg(const Ffmpeg&) = delete;
  Ffmpeg& operator=(const Ffmpeg&) = delete;

  void write(const std::vector<std::uint8_t>& bytes) {
    for (std::size_t at = 0; at < bytes.size();) {
      check_cancel();
      const ssize_t n = ::write(input_, bytes.data() + at, bytes.size() - at);
      if (n >= 0) at += static_cast<std::size_t>(n);
      if (n < 0 && errno != EINTR) finish(); // it is gone: say why
    }
  }
  // Throws Error(failed) with its last words when it did not succeed.
  void finish() {
    ::close(input_);
    input_ = -1;
    const int status = wait();
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return;
    std::string said;
    char piece[4096];
    for (ssize_t n; (n = ::read(words_, piece, sizeof piece)) > 0;)
      said.append(piece, static_cast<std::size_t>(n));
    while (!said.empty() && said.back() == '\n') said.pop_back();
    const std::string last = said.substr(said.rfind('\n') + 1);
    const char* full = std::strerror(ENOSPC);
    if (said.find(full) != std::string::npos)
      throw Error(ErrorKind::cannot_write, std::string("ffmpeg: ") + full);
    fail((WIFSIGNALED(status) ? fmt::format("was killed by signal {}", WTERMSIG(status))
                              : fmt::format("ended with {}", WEXITSTATUS(status))) +
         (last.empty() ? "" : ": " + printable(last, 150)));
  }

 private:
  [[noreturn]] static void fail(const std::string& reason) {
    throw Error(ErrorKind::failed, "ffmpeg " + reason);
  }
  int wait() {
    int status = 0;
    while (::waitpid(process_, &status, 0) < 0 && errno == EINTR) {
    }
    process_ = -1;
    return status;
  }

  pid_t process_ = -1;
  int input_ = -1, words_ = -1;
};

// An odd size repeats its last row and column: yuv420p halves the colours' resolution.
std::vector<std::uint8_t> even(const DisplayPicture& picture) {
  const int width = picture.width + picture.width % 2, height = picture.height + picture.height % 2;
  if (width == picture.width && height == picture.height) return picture.rgb;
  std::vector<std::uint8_t> rgb;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const int from = std::min(y, picture.height - 1) * picture.width + std::min(x, picture.width - 1);
      rgb.insert(rgb.end(), picture.rgb.begin() + 3 * from, picture.rgb.begin() + 3 * from + 3);
    }
  return rgb;
}

// One number of threads on every machine: the encoder's result depends on it.
std::vector<std::string> arguments(const MovieOptions& options, int width, int height,
                                   const std::string& path) {
  const std::string extension = extension_of(options.path);
  const std::string container = extension == ".mkv" ? "matroska" : extension.substr(1);
  std::istringstream words(fmt::format(
      "ffmpeg -hide_banner -nostdin -v error -y -f rawvideo -pixel_format rgb24 -video_size {}x{} -framerate "
      "{} "
      "-i pipe:0 -an -vf "
      "scale=out_color_matrix=bt709:out_range=tv:flags=bitexact+accurate_rnd+full_chroma_int,"
      "format=yuv420p -c:v libx264 -preset medium -crf 17 -threads 4 -color_primaries bt709 -color_trc bt709 "
      "-colorspace bt709 -color_range tv -fflags +bitexact -flags:v +bitexact -map_metadata -1 -f {}",
      width, height, options.fps, container));
  std::vector<std::string> list;
  for (std::string word; words >> word;) list.push_back(word);
  list.push_back("file:" + path); // whatever characters are in it
  return list;
}

} // namespace

void check_movie(const MovieOptions& options) {
  const std::string extension = extension_of(options.path);
  if (extension != ".mp4" && extension != ".mov" && extension != ".mkv")
    throw Error(ErrorKind::usage,
                printable(options.path, 300) + ": unknown movie extension; choose .mp4, .mov, .mkv");
  if (!(options.fps >= 0.01 && options.fps <= 1000))
    throw Error(ErrorKind::usage, fmt::format("--fps {}: not from 0.01 to 1000", options.fps));
  for (int c = 0; c < 3; ++c)
    if (!(options.background[c] >= 0 && options.background[c] <= 1))
      throw Error(ErrorKind::usage, "--movie-background: not three numbers from 0 to 1");
}

bool has_program(const std::string& name) {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');)
    if (::access((folder + "/" + name).c_str(), X_OK) == 0) return true;
  return false;
}

void write_movie(const MovieOptions& options, const std::vector<std::string>& pictures) {
  try {
    write_file_atomically(options.path, [&](const std::string& path) {
      std::optional<Ffmpeg> ffmpeg;
      int width = 0, height = 0;
      for (const std::string& name : pictures) {
        check_cancel();
        const DisplayPicture picture = read_picture(name, options.background);
        if (!ffmpeg) {
          width = picture.width, height = picture.height;
          ffmpeg.emplace(arguments(options, width + width % 2, height + height % 2, path));
        }
        if (picture.width != width || picture.height != height)
          throw Error(ErrorKind::failed,
                      fmt::format("{} has {} x {} pixels, the first one {} x {}", printable(name, 200),
                                  picture.width, picture.height, width, height));
        ffmpeg->write(even(picture));
      }
      ffmpeg->finish();
    });
  } catch (const Error& error) {
    const std::string what = error.what(), path = printable(options.path, 150);
    if (what.starts_with(path)) throw;
    throw Error(error.kind(), fmt::format("{}: no movie: {}; the frames are kept", path, what));
  }
}

} // namespace levelray
