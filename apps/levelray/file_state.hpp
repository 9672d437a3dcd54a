// Whether a file is still the one it was.
#pragma once

#include <cstdint>
#include <string>

namespace levelray {

struct FileState {
  std::uint64_t device = 0, number = 0, size = 0;
  std::int64_t seconds = 0, nanoseconds = 0; // of the last change
  bool operator==(const FileState&) const = default;
};

// Throws Error(bad_input) for what is not there, and for what is no regular file: to look into a pipe is to
// empty it, and a device may have no end.
FileState file_state(const std::string& path);

// Throws Error(bad_input) when a file is no longer what it was when it began to be read.
void check_unchanged(const std::string& path, const FileState& state);

// Notes a file's state now; check() throws when it is another then. What is no regular file is not watched.
class WatchedFile {
 public:
  explicit WatchedFile(const std::string& path);
  void check() const;

 private:
  std::string path_;
  FileState state_;
  bool watched_ = false;
};

} // namespace levelray
