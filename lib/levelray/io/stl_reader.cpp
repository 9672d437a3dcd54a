// STL, binary and ASCII ("StereoLithography Interface Specification", 3D Systems, 1989). Normals are skipped:
// the corners' order says the same, and writers get normals wrong.
#include "levelray/io/byte_order.hpp"
#include "levelray/io/mesh_formats.hpp"
#include "levelray/io/text_cursor.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>

namespace levelray {

namespace {

constexpr std::uint64_t header_bytes = 84; // 80 of text, and the count
constexpr std::uint64_t facet_bytes = 50;  // 12 floats, and 16 bits of attributes

void add_facet(SoupBuilder& builder, std::vector<std::uint64_t>& corners,
               const std::array<std::array<double, 3>, 3>& positions, const char* at) {
  const std::uint64_t first = builder.vertex_count();
  for (const auto& p : positions) builder.add_vertex(p[0], p[1], p[2], at);
  corners = {first, first + 1, first + 2};
  builder.add_polygon(corners, at);
}

MeshFile read_binary(SoupBuilder& builder) {
  MeshSource& source = builder.source();
  source.set_binary(true);
  const char* count_at = source.begin() + 80;
  const std::uint64_t announced = load<std::uint32_t>(count_at, false);
  const std::uint64_t held = (source.size() - header_bytes) / facet_bytes;
  const std::uint64_t rest = (source.size() - header_bytes) % facet_bytes;
  std::uint64_t count = announced;
  if (announced != held) {
    builder.truncated(count_at, fmt::format("announces {} triangles, file holds {}", announced, held));
    count = held;
  } else if (rest != 0) {
    builder.warn(fmt::format("{}: {} bytes after the last triangle ignored", source.name(), rest));
  }

  builder.reserve(3 * count, count);
  std::vector<std::uint64_t> corners;
  std::array<std::array<double, 3>, 3> positions;
  const char* facet = source.begin() + header_bytes;
  for (std::uint64_t i = 0; i < count; ++i, facet += facet_bytes) {
    for (std::size_t k = 0; k < 9; ++k) positions[k / 3][k % 3] = load<float>(facet + 12 + 4 * k, false);
    add_facet(builder, corners, positions, facet);
  }
  return builder.finish("stl", "STL");
}

// The keywords in any case; a facet ends where "endfacet" says.
class AsciiStlReader {
 public:
  explicit AsciiStlReader(SoupBuilder& builder)
      : builder_(builder), source_(builder.source()), cursor_{source_.begin(), source_.end()} {}

  MeshFile read();

 private:
  std::string_view next_word() {
    cursor_.skip_space();
    word_at_ = cursor_.at;
    return cursor_.word();
  }
  // A keyword that one or two words make ("endloop", "end loop").
  bool take(std::string_view first, std::string_view second);
  bool read_facet();
  double read_coordinate();
  bool ended() const { return word_at_ >= source_.end(); }

  SoupBuilder& builder_;
  MeshSource& source_;
  TextCursor cursor_;
  const char* word_at_ = nullptr;
  std::vector<std::uint64_t> corners_;
  std::uint64_t facets_ = 0;
};

bool AsciiStlReader::take(std::string_view first, std::string_view second) {
  const std::string_view word = next_word();
  if (word.size() == first.size() + second.size() &&
      equal_ignoring_case(word.substr(0, first.size()), first) &&
      equal_ignoring_case(word.substr(first.size()), second))
    return true;
  const char* at = word_at_;
  if (equal_ignoring_case(word, first) && equal_ignoring_case(next_word(), second)) return true;
  word_at_ = ended() ? word_at_ : at;
  return false;
}

double AsciiStlReader::read_coordinate() {
  cursor_.skip_space();
  word_at_ = cursor_.at;
  if (ended()) return 0;
  const ParsedDouble number = parse_double(cursor_.at, cursor_.end);
  if (number.end == nullptr || (number.end < cursor_.end && !is_space(*number.end))) {
    const std::string text = source_.quote(cursor_.at);
    const bool comma = text.find(',') != std::string::npos;
    source_.fail(cursor_.at, fmt::format("bad number {}{}", text, comma ? " (decimal comma?)" : ""));
  }
  cursor_.at = number.end;
  return number.value;
}

// Behind the word "facet"; false when the file ends inside.
bool AsciiStlReader::read_facet() {
  const char* facet = word_at_;
  // "normal" and its three numbers, whatever they are: some writers leave them out.
  std::string_view word = next_word();
  for (int i = 0; i < 5 && !ended() && !equal_ignoring_case(word, "outer"); ++i) word = next_word();
  const auto expect = [&](bool found, const char* what) {
    if (!found && !ended() && !cursor_.at_end()) // a word at the very end may have been cut
      source_.fail(word_at_, fmt::format("{} where \"{}\" should be", source_.quote(word_at_), what));
    return found;
  };
  if (!expect(equal_ignoring_case(word, "outer"), "outer loop")) return false;
  if (!expect(equal_ignoring_case(next_word(), "loop"), "loop")) return false;

  std::array<std::array<double, 3>, 3> positions;
  for (auto& position : positions) {
    if (!expect(equal_ignoring_case(next_word(), "vertex"), "vertex")) return false;
    for (double& x : position) {
      x = read_coordinate();
      if (ended()) return false;
    }
  }
  if (!expect(take("end", "loop"), "endloop")) return false;
  if (!expect(take("end", "facet"), "endfacet")) return false;
  add_facet(builder_, corners_, positions, facet);
  ++facets_;
  return true;
}

MeshFile AsciiStlReader::read() {
  bool in_solid = false, any_solid = false;
  const char* last = source_.begin();
  for (;;) {
    const std::string_view word = next_word();
    if (ended()) break;
    last = word_at_;
    if (equal_ignoring_case(word, "facet")) {
      if (!any_solid) source_.fail(word_at_, "\"facet\" before \"solid\"; is this STL?");
      if (read_facet()) continue;
      builder_.truncated(last, fmt::format("file ends inside facet {}", facets_ + 1));
      in_solid = false;
      break;
    }
    if (equal_ignoring_case(word, "solid")) {
      in_solid = any_solid = true;
    } else if (equal_ignoring_case(word, "endsolid") ||
               (equal_ignoring_case(word, "end") && equal_ignoring_case(next_word(), "solid"))) {
      in_solid = false;
    } else if (!any_solid) {
      source_.fail("no vertices or faces found; is this STL?");
    } else if (!equal_ignoring_case(word, "color")) {
      source_.fail(last, fmt::format("{} where \"facet\" or \"endsolid\" should be", source_.quote(last)));
    }
    cursor_.skip_rest_of_line(); // the solid's name, which may be anything
  }
  if (in_solid)
    builder_.warn(fmt::format("{}: no \"endsolid\" after {} facets; the file may be cut off",
                              source_.place(last), facets_));
  return builder_.finish("stl", "STL");
}

} // namespace

bool is_exact_binary_stl(const MeshSource& source) noexcept {
  if (source.size() < header_bytes) return false;
  const std::uint64_t count = load<std::uint32_t>(source.begin() + 80, false);
  return count > 0 && count * facet_bytes + header_bytes == source.size();
}

MeshFile read_stl(SoupBuilder& builder) {
  const MeshSource& source = builder.source();
  // Binary files may start with "solid", so that word decides last: the announced size first, then bytes that
  // no text holds.
  const bool has_header = source.size() >= header_bytes;
  const bool exact = is_exact_binary_stl(source);
  TextCursor start{source.begin(), source.end()};
  start.skip_space();
  const bool solid = equal_ignoring_case(start.word().substr(0, 5), "solid");
  const char* look_end = source.begin() + std::min<std::size_t>(source.size(), 1024);
  const bool text = std::find(source.begin(), look_end, '\0') == look_end;
  if (!exact && solid && text) return AsciiStlReader(builder).read();
  if (!has_header) source.fail(fmt::format("too short for STL: {} bytes", source.size()));
  if (!exact && text) source.fail("no vertices or faces found; is this STL?");
  return read_binary(builder);
}

} // namespace levelray
