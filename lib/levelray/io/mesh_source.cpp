#include "levelray/io/mesh_source.hpp"

#include "levelray/core/error.hpp"
#include "levelray/io/text_cursor.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace levelray {

namespace {
constexpr std::size_t longest_name = 160; // leaves 320 of an Error's 480 bytes for place, reason and hint
constexpr std::size_t longest_quote = 40;
} // namespace

std::string shown_name(const std::string& name) {
  if (name.size() <= longest_name) return printable(name, longest_name);
  std::size_t from = name.size() - (longest_name - 3);
  while (from < name.size() && (static_cast<unsigned char>(name[from]) & 0xC0) == 0x80) ++from;
  return "..." + printable(name.substr(from), longest_name);
}

std::string bytes_text(double bytes) {
  constexpr const char* units[] = {"bytes", "kB", "MB", "GB", "TB", "PB", "EB"};
  if (bytes < 1000) return fmt::format("{:.0f} bytes", bytes);
  std::size_t unit = 0;
  for (; bytes >= 999.5 && unit + 1 < std::size(units); ++unit) bytes /= 1000;
  return fmt::format("{:.{}f} {}", bytes, bytes < 9.95 ? 1 : 0, units[unit]);
}

MeshSource::MeshSource(const char* data, std::size_t size, std::string name)
    : begin_(data), end_(data + size), name_(shown_name(name)) {}

std::string MeshSource::place(const char* at) const {
  if (binary_) return fmt::format("{}@{}", name_, at - begin_);
  std::uint64_t line = 1;
  for (const char* p = begin_; p < at; ++p)
    if (*p == '\n' || (*p == '\r' && (p + 1 == end_ || p[1] != '\n'))) ++line;
  return fmt::format("{}:{}", name_, line);
}

void MeshSource::fail(const char* at, const std::string& reason) const {
  throw Error(ErrorKind::bad_input, place(at) + ": " + reason);
}

void MeshSource::fail(const std::string& reason) const {
  throw Error(ErrorKind::bad_input, name_ + ": " + reason);
}

void MeshSource::fail_limit(const std::string& reason) const {
  throw Error(ErrorKind::limit, name_ + ": " + reason);
}

std::string MeshSource::quote(const char* at) const {
  const char* stop = at;
  while (stop < end_ && !is_space(*stop) && static_cast<std::size_t>(stop - at) <= longest_quote) ++stop;
  return '"' + printable(std::string(at, stop), longest_quote) + '"';
}

} // namespace levelray
