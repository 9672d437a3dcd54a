// What a limited reader process sends to its parent, which believes none of it unchecked.
//
// A stream is: `opening`, a status, then either an error's kind and text or what was read, `closing`. Numbers
// are in the machine's own byte order: both ends are the same build on the same machine.
#pragma once

#include "levelray/core/error.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <type_traits>

namespace levelray {

// Calls write(bytes, count) for consecutive pieces.
using ByteSink = std::function<void(const void* bytes, std::size_t count)>;
// Fills `count` bytes, or throws.
using ByteSource = std::function<void(void* bytes, std::size_t count)>;

// Longest text and list that pass, in bytes and entries.
inline constexpr std::uint32_t stream_text_limit = 4096;
inline constexpr std::uint32_t stream_list_limit = 100000;

// The writing end.
class StreamOut {
 public:
  // Begins an answer; `layout` tells kinds of answers apart and changes with what they hold.
  StreamOut(const ByteSink& write, std::uint64_t layout);
  template <class T>
  void value(const T& v) {
    static_assert(std::is_trivially_copyable_v<T>);
    write_(&v, sizeof v);
  }
  // Cut to stream_text_limit bytes.
  void text(const std::string& s);
  // Cut to stream_list_limit entries, which it returns.
  std::uint32_t count(std::size_t n);
  template <class Vector>
  void array(const Vector& v) {
    if (!v.empty()) write_(v.data(), v.size() * sizeof v[0]);
  }
  // The end, without which the parent believes nothing.
  void close();

 private:
  const ByteSink& write_;
};

// An answer that is an error, whatever the layout expected.
void send_error(const ByteSink& write, ErrorKind kind, const std::string& text);

// The reading end.
class StreamIn {
 public:
  // Reads the beginning: throws the Error that was sent, or Error(bad_input) naming `path` when the bytes
  // make no sense. `read` and `path` must outlive it.
  StreamIn(const ByteSource& read, const std::string& path, std::uint64_t layout);
  [[noreturn]] void fail(const char* what) const;
  void check(bool good, const char* what) const {
    if (!good) fail(what);
  }
  template <class T>
  T value() {
    T v;
    read_(&v, sizeof v);
    return v;
  }
  std::string text(); // printable
  std::uint32_t count();
  // The caller has checked that memory for `size` elements may be taken.
  template <class Vector>
  void array(Vector& v, std::uint64_t size) {
    v.resize(size);
    if (size) read_(v.data(), size * sizeof v[0]);
  }
  void close();

 private:
  const ByteSource& read_;
  const std::string& path_;
};

} // namespace levelray
