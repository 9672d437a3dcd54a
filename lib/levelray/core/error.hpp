// The one exception type for what the outside world gets wrong: files, options, limits, disks.
//
// Our own mistakes are asserts, and numbers being numbers are values (`std::optional`, `HitStatus`); see
// lib/README.md.
#pragma once

#include <stdexcept>
#include <string>

namespace levelray {

// Each kind is the exit code that the program ends with.
enum class ErrorKind : int {
  failed = 1,       // work that could not be done, no fault of the input
  usage = 2,        // an option, a name or a combination that is not legal
  bad_input = 3,    // a file that cannot be used
  some_frames = 4,  // some frames of a sequence could not be made; the others are there
  limit = 5,        // memory, time or size limits
  mismatch = 6,     // what was compared differs by more than was allowed
  cannot_write = 74 // the output could not be written
};

// `what()` is one line without a trailing newline: place (file, file:line or file@offset), reason, hint.
// Texts that come from files or libraries are clamped, so that the line stays below `max_length` bytes and
// holds no control characters.
class Error : public std::runtime_error {
 public:
  static constexpr std::size_t max_length = 480;

  Error(ErrorKind kind, const std::string& message);
  ErrorKind kind() const noexcept { return kind_; }

 private:
  ErrorKind kind_;
};

// Thrown out of long work when `request_cancel()` was called; not an Error, because nothing went wrong.
class Cancelled : public std::exception {
 public:
  const char* what() const noexcept override { return "cancelled"; }
};

// Returns `text` with control characters and invalid UTF-8 replaced by '?', cut to at most `max_bytes` bytes
// with "..." as its end.
std::string printable(const std::string& text, std::size_t max_bytes);

} // namespace levelray
