// OFF as in Geomview's manual (M. Phillips et al., section "OFF: Object File Format"): the header word may be
// absent or glued to the counts, comments may be anywhere, colours follow vertices (COFF) and faces.
#include "levelray/io/mesh_formats.hpp"
#include "levelray/io/off_header.hpp"
#include "levelray/io/text_cursor.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace levelray {

namespace {

class OffReader {
 public:
  explicit OffReader(SoupBuilder& builder)
      : builder_(builder), source_(builder.source()), cursor_{source_.begin(), source_.end()} {}

  MeshFile read() {
    read_header();
    read_counts();
    if (read_vertices() && read_faces()) {
      skip();
      if (!cursor_.at_end())
        builder_.warn(source_.place(cursor_.at) + ": data after the last announced face ignored");
    }
    return builder_.finish("off", "OFF");
  }

 private:
  // To the next word: over spaces, line ends and comments.
  void skip() {
    for (;;) {
      cursor_.skip_space();
      if (cursor_.at_end() || *cursor_.at != '#') return;
      cursor_.skip_rest_of_line();
    }
  }
  // The same within the line; false at its end.
  bool next_in_line() {
    cursor_.skip_blanks();
    return !cursor_.at_line_end() && *cursor_.at != '#';
  }

  void read_header();
  void read_counts();
  bool read_vertices();
  bool read_faces();
  bool values_share_lines() const;
  std::uint64_t read_count(const char* what, std::uint64_t least_bytes);
  [[noreturn]] void fail_number(const char* word) const {
    const std::string text = source_.quote(word);
    const bool comma = text.find(',') != std::string::npos;
    source_.fail(word, fmt::format("bad number {}{}", text, comma ? " (decimal comma?)" : ""));
  }
  bool ends_number(const char* p) const { return p == cursor_.end || is_space(*p) || *p == '#'; }

  SoupBuilder& builder_;
  MeshSource& source_;
  TextCursor cursor_;
  OffHeader header_;
  std::uint64_t vertices_ = 0, faces_ = 0;
  bool by_line_ = true; // what follows an instance's values on its line is not read
};

void OffReader::read_header() {
  skip();
  header_ = find_off_header({cursor_.at, static_cast<std::size_t>(cursor_.end - cursor_.at)});
  if (!header_.found) {
    // Geomview lets files begin with the counts.
    if (cursor_.at_end() || parse_integer(cursor_.at, cursor_.end).end == nullptr)
      source_.fail("no vertices or faces found; is this OFF?");
    return;
  }
  if (header_.dimension)
    source_.fail(cursor_.at, "4OFF and nOFF (coordinates of other dimensions) are not supported");
  cursor_.at += header_.length;
  TextCursor ahead = cursor_;
  ahead.skip_blanks();
  if (equal_ignoring_case(ahead.word(), "binary"))
    source_.fail(cursor_.at, "binary OFF is not supported; save it as text OFF or PLY");
}

std::uint64_t OffReader::read_count(const char* what, std::uint64_t least_bytes) {
  skip();
  if (cursor_.at_end()) source_.fail(cursor_.at, fmt::format("file ends before the number of {}", what));
  const ParsedInteger count = parse_integer(cursor_.at, cursor_.end);
  if (count.end == nullptr || !ends_number(count.end))
    source_.fail(cursor_.at, fmt::format("bad number of {}: {}", what, source_.quote(cursor_.at)));
  if (count.value < 0) source_.fail(cursor_.at, fmt::format("announces {} {}", count.value, what));
  const std::uint64_t number = static_cast<std::uint64_t>(count.value);
  // The last number of the file needs no space behind it.
  if (number > (static_cast<std::uint64_t>(cursor_.end - count.end) + 1) / least_bytes &&
      !builder_.options().salvage)
    source_.fail(cursor_.at, fmt::format("announces {} {} (at least {}) but the file has {}", number, what,
                                         bytes_text(double(number) * double(least_bytes)),
                                         bytes_text(double(source_.size()))));
  cursor_.at = count.end;
  return number;
}

void OffReader::read_counts() {
  vertices_ = read_count("vertices", 6); // three digits and their spaces
  faces_ = read_count("faces", 2);
  // The number of edges: nobody needs it, and some writers leave it out.
  if (next_in_line()) {
    const ParsedInteger edges = parse_integer(cursor_.at, cursor_.end);
    if (edges.end == nullptr || !ends_number(edges.end)) fail_number(cursor_.at);
    cursor_.at = edges.end;
  }
  const std::uint64_t rest = static_cast<std::uint64_t>(cursor_.end - cursor_.at);
  builder_.reserve(std::min(vertices_, rest / 6 + 1), std::min(faces_, rest / 8 + 1));
  by_line_ = !values_share_lines();
}

// Whether vertices and faces are not one to a line: the line of the first vertex holds more than its
// coordinates, and the file has fewer lines than vertices and faces together.
bool OffReader::values_share_lines() const {
  OffReader ahead(builder_);
  ahead.cursor_ = cursor_;
  ahead.skip();
  if (ahead.cursor_.at_end()) return false;
  int words = 0;
  for (; ahead.next_in_line() && words < 4; ++words) ahead.cursor_.word();
  if (words < 4) return false;
  std::uint64_t lines = 0;
  ahead.cursor_ = cursor_;
  for (ahead.skip(); !ahead.cursor_.at_end() && lines < vertices_ + faces_; ahead.skip()) {
    ++lines;
    ahead.cursor_.skip_rest_of_line();
  }
  return lines < vertices_ + faces_;
}

bool OffReader::read_vertices() {
  const int values = by_line_ ? 3 : 3 + header_.extra_values;
  for (std::uint64_t i = 0; i < vertices_; ++i) {
    skip();
    const char* line = cursor_.at;
    double xyz[3] = {0, 0, 0};
    for (int k = 0; k < values; ++k) {
      skip();
      if (cursor_.at_end()) {
        builder_.truncated(cursor_.at, fmt::format("announces {} vertices, found {}", vertices_, i));
        return false;
      }
      const ParsedDouble number = parse_double(cursor_.at, cursor_.end);
      if (number.end == nullptr || !ends_number(number.end)) fail_number(cursor_.at);
      if (k < 3) xyz[k] = number.value;
      cursor_.at = number.end;
    }
    if (by_line_) cursor_.skip_rest_of_line();
    builder_.add_vertex(xyz[0], xyz[1], xyz[2], line);
  }
  return true;
}

bool OffReader::read_faces() {
  std::vector<std::uint64_t> corners;
  for (std::uint64_t i = 0; i < faces_; ++i) {
    skip();
    const char* line = cursor_.at;
    std::uint64_t count = 0;
    corners.clear();
    for (std::uint64_t k = 0; k <= count; ++k) {
      skip();
      if (cursor_.at_end()) {
        builder_.truncated(cursor_.at, fmt::format("announces {} faces, found {}", faces_, i));
        return false;
      }
      const ParsedInteger number = parse_integer(cursor_.at, cursor_.end);
      if (number.end == nullptr || !ends_number(number.end)) fail_number(cursor_.at);
      if (k == 0) {
        if (number.value < 0 || number.value > static_cast<std::int64_t>(max_polygon_corners))
          source_.fail(line, fmt::format("polygon with {} corners exceeds limit {}", number.value,
                                         max_polygon_corners));
        count = static_cast<std::uint64_t>(number.value);
      } else {
        if (number.value < 0 || static_cast<std::uint64_t>(number.value) >= vertices_)
          source_.fail(line, fmt::format("vertex index {}, file has {} vertices", number.value, vertices_));
        corners.push_back(static_cast<std::uint64_t>(number.value));
      }
      cursor_.at = number.end;
    }
    if (by_line_) cursor_.skip_rest_of_line(); // a colour
    builder_.add_polygon(corners, line);
  }
  return true;
}

} // namespace

MeshFile read_off(SoupBuilder& builder) {
  return OffReader(builder).read();
}

} // namespace levelray
