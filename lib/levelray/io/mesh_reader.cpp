#include "levelray/io/mesh_reader.hpp"

#include "levelray/core/error.hpp"
#include "levelray/io/input_file.hpp"
#include "levelray/io/mesh_formats.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <new>
#include <stdexcept>

namespace levelray {

namespace {

std::string supported() {
  std::string names;
  for (const std::string& name : mesh_format_names()) names += (names.empty() ? "" : ", ") + name;
  return names;
}

bool is_supported(const std::string& format) {
  const auto& names = mesh_format_names();
  return std::find(names.begin(), names.end(), format) != names.end();
}

// Behind the last dot of the file name, in lower case.
std::string extension_of(const std::string& path) {
  const std::size_t slash = path.find_last_of('/');
  const std::string file = slash == std::string::npos ? path : path.substr(slash + 1);
  const std::size_t dot = file.find_last_of('.');
  if (dot == std::string::npos || dot == 0) return "";
  std::string extension = file.substr(dot + 1);
  for (char& c : extension)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return extension;
}

void check_options(const MeshReadOptions& options) {
  if (!options.format.empty() && !is_supported(options.format))
    throw Error(ErrorKind::usage, fmt::format("unknown mesh format \"{}\"; supported: {}",
                                              printable(options.format, 40), supported()));
}

std::string upper(std::string text) {
  for (char& c : text)
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  return text;
}

// What was asked for, or what the name says, unless the bytes say something else.
std::string choose_format(const MeshSource& source, const std::string& path, const MeshReadOptions& options) {
  const std::string content = sniff_format(source);
  const std::string extension = extension_of(path);
  const std::string wanted = !options.format.empty()   ? options.format
                             : is_supported(extension) ? extension
                                                       : std::string();
  if (!wanted.empty() && !content.empty() && content != wanted)
    source.fail(fmt::format("content looks like {}, not {}; use --format {}", upper(content), upper(wanted),
                            content));
  if (!wanted.empty()) return wanted;
  if (!content.empty()) return content;
  const std::string reason = extension.empty() ? "cannot tell the format from the name or the content"
                                               : fmt::format(".{} not supported", printable(extension, 20));
  throw Error(ErrorKind::usage,
              fmt::format("{}: {}; supported: {} (--format names one)", source.name(), reason, supported()));
}

} // namespace

const std::vector<std::string>& mesh_format_names() {
  static const std::vector<std::string> names = {"obj", "ply", "stl", "off"};
  return names;
}

MeshFile parse_mesh(const char* data, std::size_t size, const std::string& name,
                    const MeshReadOptions& options) {
  check_options(options);
  // A byte order mark says UTF-8, which is what everything is read as.
  if (size >= 3 && std::string_view(data, 3) == "\xEF\xBB\xBF") {
    data += 3;
    size -= 3;
  }
  MeshSource source(data, size, name);
  if (size == 0) source.fail("empty file");
  try {
    const std::string format = choose_format(source, name, options);
    SoupBuilder builder(source, options);
    if (format == "obj") return read_obj(builder);
    if (format == "ply") return read_ply(builder);
    if (format == "stl") return read_stl(builder);
    return read_off(builder);
  } catch (const std::bad_alloc&) {
    source.fail_limit("not enough memory for the mesh");
  } catch (const std::length_error&) {
    source.fail_limit("not enough memory for the mesh");
  }
}

MeshFile read_mesh(const std::string& path, const MeshReadOptions& options) {
  check_options(options);
  if (path == "-" && options.format.empty())
    throw Error(ErrorKind::usage, fmt::format("standard input needs --format; supported: {}", supported()));
  try {
    const uninitialized_vector<char> bytes = read_input(path, options.max_memory);
    return parse_mesh(bytes.data(), bytes.size(), path == "-" ? "standard input" : path, options);
  } catch (const std::bad_alloc&) {
    throw Error(ErrorKind::limit, shown_name(path) + ": not enough memory to read it");
  }
}

} // namespace levelray
