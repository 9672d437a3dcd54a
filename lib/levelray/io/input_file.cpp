#include "levelray/io/input_file.hpp"

#include "levelray/core/error.hpp"
#include "levelray/core/parallel.hpp"
#include "levelray/io/mesh_source.hpp"

#include <algorithm>
#include <cerrno>
#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>

namespace levelray {

namespace {

constexpr std::size_t chunk_bytes = std::size_t{1} << 24; // between two looks at cancellation

class Descriptor {
 public:
  Descriptor(int fd, bool owned) : fd_(fd), owned_(owned) {}
  ~Descriptor() {
    if (owned_ && fd_ >= 0) ::close(fd_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int get() const { return fd_; }

 private:
  int fd_;
  bool owned_;
};

[[noreturn]] void fail(const std::string& name, const std::string& reason,
                       ErrorKind kind = ErrorKind::bad_input) {
  throw Error(kind, name + ": " + reason);
}

std::string reason_of(int error) {
  return std::generic_category().message(error);
}

// Up to `size` bytes, fewer only at the end of the file. Waits at most a tenth of a second at a time for
// pipes, so that cancellation is noticed.
std::size_t read_some(int fd, char* to, std::size_t size, const std::string& name) {
  std::size_t got = 0;
  while (got < size) {
    check_cancel();
    pollfd ready{fd, POLLIN, 0};
    if (::poll(&ready, 1, 100) == 0) continue;
    const ssize_t n = ::read(fd, to + got, std::min(size - got, chunk_bytes));
    if (n == 0) break;
    if (n > 0) {
      got += static_cast<std::size_t>(n);
    } else if (errno != EINTR && errno != EAGAIN) {
      fail(name, "cannot be read: " + reason_of(errno));
    }
  }
  return got;
}

[[noreturn]] void fail_too_large(const std::string& name, std::uint64_t max_bytes) {
  fail(name,
       fmt::format("larger than the memory limit of {}; raise --max-memory", bytes_text(double(max_bytes))),
       ErrorKind::limit);
}

// Input of a size that is not known beforehand.
uninitialized_vector<char> read_stream(int fd, const std::string& name, std::uint64_t max_bytes) {
  uninitialized_vector<char> bytes;
  std::size_t used = 0;
  for (;;) {
    if (used == bytes.size()) bytes.resize(std::max<std::size_t>(std::size_t{1} << 16, used + used / 2));
    const std::size_t n = read_some(fd, bytes.data() + used, bytes.size() - used, name);
    used += n;
    if (used > max_bytes) fail_too_large(name, max_bytes);
    if (used < bytes.size()) break;
  }
  bytes.resize(used);
  if (bytes.empty()) fail(name, "empty; nothing came through the pipe");
  return bytes;
}

} // namespace

uninitialized_vector<char> read_input(const std::string& path, std::uint64_t max_bytes) {
  if (path == "-") return read_stream(STDIN_FILENO, "standard input", max_bytes);
  const std::string name = shown_name(path);
  if (path.empty()) fail("\"\"", "no file name given");
  if (path.find('\0') != std::string::npos) fail(name, "no such file");

  // Without O_NONBLOCK, opening a FIFO that nobody writes to never returns.
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK), true);
  if (file.get() < 0) {
    const int error = errno;
    if (error == ENOENT) fail(name, "no such file");
    if (error == EACCES) fail(name, "no permission to read it");
    fail(name, "cannot be opened: " + reason_of(error));
  }
  struct stat info {};
  if (::fstat(file.get(), &info) != 0) fail(name, "cannot be read: " + reason_of(errno));
  if (S_ISDIR(info.st_mode)) fail(name, "is a directory, not a mesh file");
  if (S_ISFIFO(info.st_mode))
    fail(name, "is a FIFO; feed it through standard input: - --format FORMAT < FIFO");
  if (!S_ISREG(info.st_mode)) fail(name, "is not a regular file");
  if (info.st_size <= 0) fail(name, "empty file");
  const std::uint64_t size = static_cast<std::uint64_t>(info.st_size);
  if (size > max_bytes) fail_too_large(name, max_bytes);

  uninitialized_vector<char> bytes(static_cast<std::size_t>(size));
  const std::size_t got = read_some(file.get(), bytes.data(), bytes.size(), name);
  if (got < bytes.size()) fail(name, "became shorter while it was read; is it still being written?");
  return bytes;
}

} // namespace levelray
