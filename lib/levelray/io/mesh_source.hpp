// The bytes of a mesh file under the name that messages use, and where in them something is wrong.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace levelray {

// Bytes of a file. Places are pointers into it; they become "name:line" or "name@offset" only when a message
// needs them, so that readers carry no line counter.
class MeshSource {
 public:
  MeshSource(const char* data, std::size_t size, std::string name);

  const char* begin() const noexcept { return begin_; }
  const char* end() const noexcept { return end_; }
  std::size_t size() const noexcept { return static_cast<std::size_t>(end_ - begin_); }
  const std::string& name() const noexcept { return name_; }

  // From here on places are byte offsets (`true`) or line numbers.
  void set_binary(bool binary) noexcept { binary_ = binary; }

  // "name:line", counted from 1, with LF, CR LF and CR alone as line ends; "name@offset" for binary data.
  std::string place(const char* at) const;

  // Throw Error(bad_input), "place: reason" and "name: reason".
  [[noreturn]] void fail(const char* at, const std::string& reason) const;
  [[noreturn]] void fail(const std::string& reason) const;
  // Throws Error(limit), "name: reason".
  [[noreturn]] void fail_limit(const std::string& reason) const;

  // The file's text at `at` up to the next blank, printable, quoted and shortened for a message.
  std::string quote(const char* at) const;

 private:
  const char* begin_;
  const char* end_;
  std::string name_;
  bool binary_ = false;
};

// "1.5 GB": powers of ten, two digits.
std::string bytes_text(double bytes);

// A path or name as messages show it: printable, and cut in front when longer than a message can bear.
std::string shown_name(const std::string& name);

} // namespace levelray
