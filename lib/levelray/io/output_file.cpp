#include "levelray/io/output_file.hpp"

#include "levelray/core/error.hpp"

#include <array>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <climits>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <fmt/format.h>
#include <map>
#include <mutex>
#include <random>
#include <sys/stat.h>
#include <unistd.h>
#include <vector>

namespace levelray {

namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const std::string& path, const std::string& reason) {
  throw Error(ErrorKind::cannot_write, fmt::format("{}: cannot write: {}", printable(path, 300), reason));
}
[[noreturn]] void fail_errno(const std::string& path, int error) {
  const char* hint = error == ENOENT ? "; the folder must exist" : "";
  fail(path, std::strerror(error) + std::string(hint));
}

// Paths of temporary files that exist now, where a signal handler can read them: fixed memory, and a state
// that is `full` only while the path is complete. The process is noted, so that a forked child never removes
// its parent's files.
struct Slot {
  enum State : int { free, filling, full };
  std::atomic<int> state{free};
  std::atomic<pid_t> owner{0};
  char path[PATH_MAX] = {};
};
static_assert(std::atomic<int>::is_always_lock_free && std::atomic<pid_t>::is_always_lock_free);
std::array<Slot, 16> g_slots;

// The middle of temporary names: what processes on other machines that share the folder differ by.
std::string host_name() {
  char name[41] = {}; // cut: what matters is that it is always the same here
  ::gethostname(name, sizeof name - 1);
  std::string host(name, ::strnlen(name, sizeof name));
  for (char& c : host)
    if (c == '/') c = '_';
  return host.empty() ? "localhost" : host;
}

// ".name.host." of a target; a name that is cut stays below NAME_MAX together with its decoration.
std::string temporary_prefix(const std::string& name) {
  static const std::string host = host_name();
  return "." + name.substr(0, 180) + "." + host + ".";
}

// The process that a temporary name ends with: "PID.XXXXXXXX.tmp"; 0 when it does not.
pid_t process_of(std::string_view end) {
  const std::size_t dot = end.find('.');
  if (dot == 0 || dot > 9 || end.size() != dot + 13 || !end.ends_with(".tmp")) return 0;
  pid_t process = 0;
  const auto [stop, error] = std::from_chars(end.data(), end.data() + dot, process);
  const bool hex = end.substr(dot + 1, 8).find_first_not_of("0123456789abcdef") == std::string_view::npos;
  return error == std::errc() && stop == end.data() + dot && hex ? process : 0;
}

// A registered temporary file, removed unless released.
class TemporaryFile {
 public:
  TemporaryFile(const std::string& target, const std::string& shown) {
    const fs::path folder = fs::path(target).parent_path();
    const std::string prefix = temporary_prefix(fs::path(target).filename().string());
    remove_stale_temporary_files(target);
    std::random_device random;
    for (int attempt = 0; attempt < 100; ++attempt) {
      path_ = (folder / fmt::format("{}{}.{:08x}.tmp", prefix, ::getpid(), random())).string();
      if (path_.size() >= PATH_MAX) fail_errno(shown, ENAMETOOLONG);
      take_slot();
      const int file = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
      if (file >= 0) {
        ::close(file);
        return;
      }
      const int error = errno;
      drop_slot();
      if (error != EEXIST) fail_errno(shown, error);
    }
    fail_errno(shown, EEXIST);
  }
  ~TemporaryFile() {
    if (!released_) ::unlink(path_.c_str());
    drop_slot();
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  const std::string& path() const { return path_; }
  void release() { released_ = true; }

 private:
  void take_slot() {
    for (Slot& slot : g_slots) {
      int expected = Slot::free;
      if (!slot.state.compare_exchange_strong(expected, Slot::filling)) continue;
      std::memcpy(slot.path, path_.c_str(), path_.size() + 1);
      slot.owner = ::getpid();
      slot.state = Slot::full;
      slot_ = &slot;
      return;
    }
    // More than 16 writes at once: the file is still removed on every path but a signal's.
  }
  void drop_slot() {
    if (slot_) slot_->state = Slot::free;
    slot_ = nullptr;
  }

  std::string path_;
  Slot* slot_ = nullptr;
  bool released_ = false;
};

// Where a link leads; the path itself when it is none or leads nowhere.
std::string follow_link(const std::string& path) {
  std::error_code ignored;
  if (!fs::is_symlink(fs::symlink_status(path, ignored))) return path;
  const fs::path target = fs::weakly_canonical(path, ignored);
  return ignored || target.empty() ? path : target.string();
}

std::string folder_of(const std::string& path) {
  const std::string folder = fs::path(path).parent_path().string();
  return folder.empty() ? "." : folder;
}

// Whether `target` exists as something that is written in place. Throws for folders and files without
// permission.
bool is_device(const std::string& target, const std::string& shown, mode_t* mode = nullptr) {
  struct stat status = {};
  if (::stat(target.c_str(), &status) != 0) {
    if (errno == ENOENT) return false;
    fail_errno(shown, errno);
  }
  if (S_ISDIR(status.st_mode)) fail_errno(shown, EISDIR);
  if (::faccessat(AT_FDCWD, target.c_str(), W_OK, AT_EACCESS) != 0) fail_errno(shown, errno);
  if (mode) *mode = status.st_mode & 07777;
  return !S_ISREG(status.st_mode);
}

void sync_file(const std::string& path, const std::string& shown, mode_t mode) {
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) fail_errno(shown, errno);
  int error = mode != 0 && ::fchmod(file, mode) != 0 ? errno : 0;
  if (error == 0 && ::fsync(file) != 0) error = errno;
  ::close(file);
  if (error != 0) fail_errno(shown, error);
}

void sync_folder(const std::string& folder, const std::string& shown) {
  const int file = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (file < 0) return; // folders that may be written but not read exist: nothing to sync through
  const int error = ::fsync(file) != 0 ? errno : 0;
  ::close(file);
  if (error != 0 && error != EINVAL && error != ENOTSUP)
    fail_errno(shown, error); // EINVAL: no such notion here
}

void write_bytes(const std::string& path, std::string_view content) {
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (file < 0) fail_errno(path, errno);
  int error = 0;
  while (!content.empty() && error == 0) {
    const ssize_t written = ::write(file, content.data(), std::min<std::size_t>(content.size(), 1u << 30));
    if (written >= 0)
      content.remove_prefix(static_cast<std::size_t>(written));
    else if (errno != EINTR)
      error = errno;
  }
  if (::close(file) != 0 && error == 0) error = errno; // NFS reports late errors here
  if (error != 0) fail_errno(path, error);
}

std::string replace_all(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
    text.replace(at, from.size(), to);
  return text;
}

} // namespace

void write_file_atomically(const std::string& path, const std::function<void(const std::string&)>& write) {
  if (path.empty()) fail("\"\"", "an empty path");
  const std::string target = follow_link(path);
  mode_t mode = 0;
  if (is_device(target, path, &mode)) return write(target);

  TemporaryFile temporary(target, path);
  try {
    write(temporary.path());
  } catch (const Error& error) {
    throw Error(error.kind(), replace_all(error.what(), temporary.path(), path));
  }
  sync_file(temporary.path(), path, mode);
  if (::rename(temporary.path().c_str(), target.c_str()) != 0) fail_errno(path, errno);
  temporary.release();
  sync_folder(folder_of(target), path);
}

void write_file_atomically(const std::string& path, std::string_view content) {
  write_file_atomically(path, [&](const std::string& temporary) { write_bytes(temporary, content); });
}

void check_writable(const std::string& path) {
  if (path.empty()) fail("\"\"", "an empty path");
  const std::string target = follow_link(path);
  if (is_device(target, path)) return;
  const TemporaryFile probe(target, path); // the only test that knows about quotas and read-only mounts
}

void remove_stale_temporary_files(const std::string& path) {
  // What is left over in a folder is looked up once: folders of sequences are long.
  static std::mutex mutex;
  static std::map<std::string, std::vector<std::string>> left_over;
  const std::lock_guard lock(mutex);
  const std::string folder = folder_of(path);
  const auto [place, is_new] = left_over.try_emplace(folder);
  std::vector<std::string>& names = place->second;
  std::error_code error;
  if (is_new)
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
      if (std::string name = entry->path().filename().string();
          name.starts_with('.') && name.ends_with(".tmp"))
        names.push_back(std::move(name));

  const std::string prefix = temporary_prefix(fs::path(path).filename().string());
  for (std::string& name : names) {
    const pid_t process =
        name.starts_with(prefix) ? process_of(std::string_view(name).substr(prefix.size())) : 0;
    if (process > 0 && ::kill(process, 0) != 0 && errno == ESRCH)
      fs::remove(fs::path(folder) / name, error); // somebody else may have been faster
  }
}

void remove_temporary_files() noexcept {
  const pid_t self = ::getpid();
  for (Slot& slot : g_slots)
    if (slot.state == Slot::full && slot.owner == self) ::unlink(slot.path);
}

} // namespace levelray
