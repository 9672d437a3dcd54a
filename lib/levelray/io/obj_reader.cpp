// Wavefront OBJ: vertices and faces of the "Object Files (.obj)" appendix B1 of the Advanced Visualizer
// manual; everything else is skipped, with a remark where it would have been geometry.
#include "levelray/io/mesh_formats.hpp"
#include "levelray/io/text_cursor.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <fmt/format.h>
#include <string_view>

namespace levelray {

namespace {

constexpr std::array<std::string_view, 17> free_form_words = {
    "vp",   "cstype", "deg",  "bmat", "step", "curv", "curv2", "surf", "parm",
    "trim", "hole",   "scrv", "sp",   "end",  "con",  "res",   "cdc"};
constexpr std::array<std::string_view, 21> silent_words = {
    "g",      "s",     "o",        "mg",       "usemtl",     "mtllib",    "usemap",
    "maplib", "bevel", "c_interp", "d_interp", "lod",        "bzp",       "ctech",
    "stech",  "call",  "csh",      "vc",       "shadow_obj", "trace_obj", "newmtl"};

template <std::size_t N>
bool contains(const std::array<std::string_view, N>& words, std::string_view word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

class ObjReader {
 public:
  explicit ObjReader(SoupBuilder& builder)
      : builder_(builder), source_(builder.source()), cursor_{source_.begin(), source_.end()} {}

  MeshFile read() {
    reserve();
    while (!cursor_.at_end()) {
      cursor_.skip_space();
      if (!cursor_.at_end()) read_line();
    }
    if (lines_.number) builder_.set_other_content("line and point elements");
    if (free_form_.number) builder_.set_other_content("free-form curves and surfaces (not supported)");
    if (lines_.number)
      remark(lines_, "line or point element", "line and point elements", "they bound no volume");
    if (free_form_.number)
      remark(free_form_, "free-form statement", "free-form statements", "only polygons are read");
    if (unknown_.number)
      remark(unknown_, "line with an unknown keyword", "lines with unknown keywords", "is this OBJ?");
    return builder_.finish("obj", "OBJ");
  }

 private:
  struct Ignored {
    std::uint64_t number = 0;
    const char* first = nullptr;
    void add(const char* at) {
      if (number++ == 0) first = at;
    }
  };

  void reserve();
  void read_line();
  void read_vertex(const char* line);
  void read_face(const char* line, std::size_t keyword_length);
  std::uint64_t read_corner();
  bool next_word();
  void skip_logical_line();
  bool cut_off() const { return cursor_.at_end() && !is_line_end(source_.end()[-1]); }
  void remark(const Ignored& ignored, const char* one, const char* many, const char* reason) {
    builder_.warn(fmt::format("{}: {} {} ignored; {}", source_.place(ignored.first), ignored.number,
                              ignored.number == 1 ? one : many, reason));
  }

  SoupBuilder& builder_;
  MeshSource& source_;
  TextCursor cursor_;
  std::vector<std::uint64_t> corners_;
  Ignored lines_, free_form_, unknown_;
};

// Counts the lines that start with "v " and "f ": exact for nearly all files, harmless for the others,
// because a line of a vertex takes at least 8 bytes of the file and one of a face at least 8.
void ObjReader::reserve() {
  std::uint64_t vertices = 0, faces = 0, sides = 0;
  const char* end = source_.end();
  for (const char* line = source_.begin(); line < end;) {
    if (end - line > 2 && is_blank(line[1])) {
      if (line[0] == 'v') ++vertices;
      if (line[0] == 'f' && faces++ == 0) {
        TextCursor words{line + 1, end};
        for (words.skip_blanks(); !words.at_line_end(); words.skip_blanks()) {
          words.word();
          ++sides;
        }
      }
    }
    const void* feed = std::memchr(line, '\n', static_cast<std::size_t>(end - line));
    if (feed == nullptr) break;
    line = static_cast<const char*>(feed) + 1;
  }
  const std::uint64_t per_face = std::clamp<std::uint64_t>(sides, 3, 4) - 2;
  builder_.reserve(vertices, std::min(faces * per_face, source_.size() / 8 + 1));
}

// Moves to the next word of the logical line, over "\" line ends; false at its end or at a comment.
bool ObjReader::next_word() {
  for (;;) {
    cursor_.skip_blanks();
    if (cursor_.at_line_end() || *cursor_.at == '#') return false;
    if (*cursor_.at != '\\') return true;
    TextCursor ahead{cursor_.at + 1, cursor_.end};
    ahead.skip_blanks();
    if (!ahead.at_line_end()) return true;
    ahead.skip_line_end();
    cursor_ = ahead;
  }
}

void ObjReader::skip_logical_line() {
  for (;;) {
    cursor_.skip_rest_of_line();
    const bool continued = cursor_.at > source_.begin() && cursor_.at[-1] == '\\';
    cursor_.skip_line_end();
    if (!continued || cursor_.at_end()) return;
  }
}

void ObjReader::read_line() {
  const char* line = cursor_.at;
  const char first = *line;
  const bool short_word = cursor_.end - line > 1 && (is_space(line[1]) || line[1] == '\\');
  if (short_word && first == 'v') return read_vertex(line);
  if (short_word && first == 'f') return read_face(line, 1);
  if (first == '#') return cursor_.skip_rest_of_line();
  if (first == '\\' || first == '\0' || (first > 0 && first < ' '))
    source_.fail(line, fmt::format("unexpected byte 0x{:02X}; the file is damaged or no text",
                                   static_cast<unsigned>(static_cast<unsigned char>(first))));

  const std::string_view word = cursor_.word();
  cursor_.at = line;
  if (word == "v" || word == "f") // the file's last byte
    return builder_.truncated(line, word == "v" ? "incomplete vertex" : "incomplete face"),
           cursor_.skip_rest_of_line();
  if (word == "vt" || word == "vn") return skip_logical_line();
  if (word == "fo") return read_face(line, 2); // an older word for f
  if (word == "l" || word == "p") {
    lines_.add(line);
    return skip_logical_line();
  }
  if (contains(silent_words, word)) return cursor_.skip_rest_of_line();
  if (contains(free_form_words, word)) {
    free_form_.add(line);
    return skip_logical_line();
  }
  unknown_.add(line);
  cursor_.skip_rest_of_line();
}

void ObjReader::read_vertex(const char* line) {
  double xyz[3];
  cursor_.at = line + 1;
  for (int i = 0; i < 3; ++i) {
    if (!next_word()) {
      if (cut_off()) return builder_.truncated(line, "incomplete vertex");
      source_.fail(line, "incomplete vertex; three coordinates are needed");
    }
    const ParsedDouble number = parse_double(cursor_.at, cursor_.end);
    if (number.end == nullptr ||
        (number.end < cursor_.end && !is_space(*number.end) && *number.end != '#' && *number.end != '\\')) {
      const std::string text = source_.quote(cursor_.at);
      const bool comma = text.find(',') != std::string::npos;
      source_.fail(line, fmt::format("bad number {}{}", text, comma ? " (decimal comma?)" : ""));
    }
    xyz[i] = number.value;
    cursor_.at = number.end;
  }
  // A weight or a colour may follow; anything else is a line run into another.
  while (next_word()) {
    const ParsedDouble number = parse_double(cursor_.at, cursor_.end);
    if (number.end == nullptr ||
        (number.end < cursor_.end && !is_space(*number.end) && *number.end != '#' && *number.end != '\\'))
      source_.fail(line, fmt::format("bad number {} after a vertex", source_.quote(cursor_.at)));
    cursor_.at = number.end;
  }
  cursor_.skip_rest_of_line();
  builder_.add_vertex(xyz[0], xyz[1], xyz[2], line);
}

// One corner "v", "v/t", "v//n" or "v/t/n"; the vertex it names, counted from 0.
std::uint64_t ObjReader::read_corner() {
  const char* word = cursor_.at;
  const ParsedInteger index = parse_integer(word, cursor_.end);
  const char* p = index.end;
  if (p != nullptr)
    for (int slash = 0; slash < 2 && p < cursor_.end && *p == '/'; ++slash) {
      const ParsedInteger other = parse_integer(p + 1, cursor_.end);
      p = other.end != nullptr ? other.end : p + 1;
    }
  if (p == nullptr || (p < cursor_.end && !is_space(*p) && *p != '#' && *p != '\\'))
    source_.fail(word,
                 fmt::format("bad face corner {}; expected v, v/t, v//n or v/t/n", source_.quote(word)));
  cursor_.at = p;

  const std::uint64_t count = builder_.vertex_count();
  if (index.value == 0) source_.fail(word, "vertex index 0; OBJ counts from 1");
  if (index.value > 0) return static_cast<std::uint64_t>(index.value) - 1;
  const std::uint64_t back = static_cast<std::uint64_t>(-index.value);
  if (back > count)
    source_.fail(word,
                 fmt::format("vertex index {}, file has {} vertices before this line", index.value, count));
  return count - back;
}

void ObjReader::read_face(const char* line, std::size_t keyword_length) {
  corners_.clear();
  cursor_.at = line + keyword_length;
  while (next_word()) {
    corners_.push_back(read_corner());
    if (corners_.size() > max_polygon_corners)
      source_.fail(line, fmt::format("polygon with more than {} corners", max_polygon_corners));
  }
  // A last line that no line end closes may have been cut.
  if (corners_.size() < 3 && cut_off()) return builder_.truncated(line, "incomplete face");
  if (cut_off() && source_.end()[-1] == '/') return builder_.truncated(line, "incomplete face");
  cursor_.skip_rest_of_line();
  builder_.add_polygon(corners_, line);
}

} // namespace

MeshFile read_obj(SoupBuilder& builder) {
  return ObjReader(builder).read();
}

} // namespace levelray
