#include "file_state.hpp"

#include "levelray/core/error.hpp"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <sys/stat.h>

namespace levelray {

FileState file_state(const std::string& path) {
  struct stat status = {};
  if (::stat(path.c_str(), &status) != 0)
    throw Error(ErrorKind::bad_input, printable(path, 300) + ": " + std::strerror(errno));
  if (!S_ISREG(status.st_mode))
    throw Error(ErrorKind::bad_input, printable(path, 300) + ": not a regular file");
  return {status.st_dev, status.st_ino, static_cast<std::uint64_t>(status.st_size), status.st_mtim.tv_sec,
          status.st_mtim.tv_nsec};
}

void check_unchanged(const std::string& path, const FileState& state) {
  if (!(file_state(path) == state))
    throw Error(ErrorKind::bad_input,
                printable(path, 300) + ": changed while it was read; run again when it is complete");
}

WatchedFile::WatchedFile(const std::string& path) : path_(path) {
  std::error_code ignored;
  if (path == "-" || !std::filesystem::is_regular_file(path, ignored)) return;
  state_ = file_state(path);
  watched_ = true;
}

void WatchedFile::check() const {
  if (watched_) check_unchanged(path_, state_);
}

} // namespace levelray
