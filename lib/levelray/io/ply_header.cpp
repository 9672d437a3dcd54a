#include "levelray/io/ply_header.hpp"

#include "levelray/core/error.hpp"
#include "levelray/io/text_cursor.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <optional>

namespace levelray {

namespace {

constexpr std::size_t max_header_bytes = 65536;

std::optional<PlyType> type_named(std::string_view name) {
  struct Name {
    std::string_view text;
    PlyType type;
  };
  static constexpr Name names[] = {
      {"char", PlyType::int8},      {"int8", PlyType::int8},       {"uchar", PlyType::uint8},
      {"uint8", PlyType::uint8},    {"short", PlyType::int16},     {"int16", PlyType::int16},
      {"ushort", PlyType::uint16},  {"uint16", PlyType::uint16},   {"int", PlyType::int32},
      {"int32", PlyType::int32},    {"uint", PlyType::uint32},     {"uint32", PlyType::uint32},
      {"float", PlyType::float32},  {"float32", PlyType::float32}, {"double", PlyType::float64},
      {"float64", PlyType::float64}};
  for (const Name& name_and_type : names)
    if (name_and_type.text == name) return name_and_type.type;
  return std::nullopt;
}

// One header line at a time, as words.
class HeaderReader {
 public:
  explicit HeaderReader(const MeshSource& source)
      : source_(source), cursor_{source.begin(), source.begin() + std::min(source.size(), max_header_bytes)} {
  }

  PlyHeader read() {
    next_line();
    if (word(0) != "ply") source_.fail("does not start with \"ply\"; is this PLY?");
    cr_only_ = line_end_was_cr_;
    bool have_format = false;
    for (;;) {
      next_line();
      const std::string_view keyword = word(0);
      if (keyword == "end_header") break;
      if (keyword.empty() || keyword == "comment" || keyword == "obj_info") continue;
      if (keyword == "format") {
        read_format();
        have_format = true;
      } else if (keyword == "element") {
        read_element();
      } else if (keyword == "property") {
        read_property();
      } else {
        source_.fail(line_, fmt::format("unknown header keyword {}", source_.quote(keyword.data())));
      }
    }
    if (!have_format) source_.fail("no \"format\" line in the PLY header");
    header_.body = cursor_.at;
    return header_;
  }

 private:
  std::string_view word(std::size_t i) const { return i < words_.size() ? words_[i] : std::string_view(); }

  void next_line() {
    words_.clear();
    cursor_.skip_blanks();
    line_ = cursor_.at;
    for (cursor_.skip_blanks(); !cursor_.at_line_end(); cursor_.skip_blanks())
      words_.push_back(cursor_.word());
    if (cursor_.at_end()) {
      // "end_header" may be the file's last bytes.
      if (word(0) == "end_header" && cursor_.at == source_.end()) return;
      source_.fail(
          source_.size() > max_header_bytes
              ? fmt::format("header not terminated within {} bytes; no \"end_header\"", max_header_bytes)
              : "header not terminated; no \"end_header\"");
    }
    // A line feed after a lone CR belongs to the data when the header's lines end with CR alone.
    line_end_was_cr_ = *cursor_.at == '\r' && !(cursor_.end - cursor_.at > 1 && cursor_.at[1] == '\n');
    if (cr_only_ && *cursor_.at == '\r')
      ++cursor_.at;
    else
      cursor_.skip_line_end();
  }

  [[noreturn]] void fail(const std::string& reason) const { source_.fail(line_, reason); }
  std::string quoted(std::size_t i) const {
    return i < words_.size() ? source_.quote(words_[i].data()) : std::string("nothing");
  }

  void read_format() {
    if (word(1) == "ascii")
      header_.encoding = PlyEncoding::ascii;
    else if (word(1) == "binary_little_endian")
      header_.encoding = PlyEncoding::little_endian;
    else if (word(1) == "binary_big_endian")
      header_.encoding = PlyEncoding::big_endian;
    else
      fail(
          fmt::format("unknown format {}; legal: ascii, binary_little_endian, binary_big_endian", quoted(1)));
    if (word(2) != "1.0") fail(fmt::format("unknown format version {}; 1.0 is supported", quoted(2)));
  }

  void read_element() {
    PlyElement element;
    element.name = std::string(word(1));
    element.at = line_;
    const std::string_view number = word(2);
    const ParsedInteger count = parse_integer(number.data(), number.data() + number.size());
    if (number.empty() || count.end != number.data() + number.size())
      fail(fmt::format("element {} announces {} where a count should be", quoted(1), quoted(2)));
    if (count.value < 0) fail(fmt::format("announces {} {}", count.value, element.plural()));
    element.count = static_cast<std::uint64_t>(count.value);
    for (const PlyElement& other : header_.elements)
      if (other.name == element.name) fail(fmt::format("second element {}", quoted(1)));
    header_.elements.push_back(element);
  }

  PlyType read_type(std::size_t i) const {
    const std::optional<PlyType> type = type_named(word(i));
    if (!type) fail(fmt::format("unknown type {}", quoted(i)));
    return *type;
  }

  void read_property() {
    if (header_.elements.empty()) fail("property before any element");
    PlyProperty property;
    property.is_list = word(1) == "list";
    const std::size_t name = property.is_list ? 4 : 2;
    if (property.is_list) {
      property.count_type = read_type(2);
      if (!is_integer(property.count_type)) fail(fmt::format("list count of type {}", quoted(2)));
    }
    property.type = read_type(name - 1);
    if (words_.size() <= name) fail("property without a name");
    property.name = std::string(words_[name]);
    for (const PlyProperty& other : header_.elements.back().properties)
      if (other.name == property.name) fail(fmt::format("second property {}", quoted(name)));
    header_.elements.back().properties.push_back(property);
  }

  const MeshSource& source_;
  TextCursor cursor_;
  PlyHeader header_;
  const char* line_ = nullptr;
  std::vector<std::string_view> words_;
  bool line_end_was_cr_ = false, cr_only_ = false;
};

} // namespace

std::size_t ply_type_size(PlyType type) noexcept {
  constexpr std::size_t sizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
  return sizes[static_cast<std::size_t>(type)];
}

std::string PlyElement::plural() const {
  if (name == "vertex") return "vertices";
  if (name == "face") return "faces";
  return printable(name, 40) + " elements";
}

std::uint64_t PlyElement::least_bytes(PlyEncoding encoding) const noexcept {
  std::uint64_t bytes = 0;
  for (const PlyProperty& property : properties)
    bytes += encoding == PlyEncoding::ascii
                 ? 2
                 : ply_type_size(property.is_list ? property.count_type : property.type);
  return bytes;
}

PlyHeader read_ply_header(const MeshSource& source) {
  return HeaderReader(source).read();
}

} // namespace levelray
