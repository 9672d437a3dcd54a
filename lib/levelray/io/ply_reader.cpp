// PLY bodies: text and binary through the same loops, one small class each for how a value is fetched.
#include "levelray/io/byte_order.hpp"
#include "levelray/io/mesh_formats.hpp"
#include "levelray/io/ply_header.hpp"
#include "levelray/io/text_cursor.hpp"

#include "levelray/core/error.hpp"
#include "levelray/core/parallel.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace levelray {

namespace {

struct EndOfData {}; // thrown by values, caught by the loop over an element's instances

// A fetched value is a double for numbers, an int64 for counts and indices; `at` is where the next one
// begins.
class BinaryValues {
 public:
  BinaryValues(MeshSource& source, const char* body, bool big) : source_(source), at_(body), big_(big) {
    source.set_binary(true);
  }
  const char* at() const { return at_; }
  void begin_instance() {}
  void skip_padding() {}

  double number(PlyType type) { return fetch<double>(type); }
  std::int64_t integer(PlyType type) { return fetch<std::int64_t>(type); }
  void skip(PlyType type, std::uint64_t count) {
    const std::uint64_t size = ply_type_size(type);
    if (static_cast<std::uint64_t>(source_.end() - at_) / size < count) throw EndOfData();
    at_ += size * count;
  }

 private:
  template <class As>
  As fetch(PlyType type) {
    switch (type) {
    case PlyType::int8:
      return fetch_as<As, std::int8_t>();
    case PlyType::uint8:
      return fetch_as<As, std::uint8_t>();
    case PlyType::int16:
      return fetch_as<As, std::int16_t>();
    case PlyType::uint16:
      return fetch_as<As, std::uint16_t>();
    case PlyType::int32:
      return fetch_as<As, std::int32_t>();
    case PlyType::uint32:
      return fetch_as<As, std::uint32_t>();
    case PlyType::float32:
      return fetch_as<As, float>();
    case PlyType::float64:
      return fetch_as<As, double>();
    }
    throw EndOfData();
  }
  template <class As, class T>
  As fetch_as() {
    if (source_.end() - at_ < static_cast<std::ptrdiff_t>(sizeof(T))) throw EndOfData();
    const T value = load<T>(at_, big_);
    at_ += sizeof(T);
    return static_cast<As>(value);
  }

  MeshSource& source_;
  const char* at_;
  bool big_;
};

class TextValues {
 public:
  TextValues(MeshSource& source, const char* body) : source_(source), cursor_{body, source.end()} {}
  const char* at() const { return cursor_.at; }

  // Instances begin on lines of their own, or a value too many or too few would shift all that follow. Within
  // one, lines may be wrapped.
  void begin_instance() {
    cursor_.skip_blanks();
    const char* here = cursor_.at;
    cursor_.skip_space();
    if (here == cursor_.at && !cursor_.at_end() && here > source_.begin() && !at_line_start(here))
      source_.fail(here, fmt::format("unexpected value {}; the values of a line do not match the header",
                                     source_.quote(here)));
  }
  void skip_padding() { cursor_.skip_space(); }
  double number(PlyType) {
    const char* word = next();
    const ParsedDouble parsed = parse_double(word, cursor_.end);
    check(word, parsed.end);
    return parsed.value;
  }
  std::int64_t integer(PlyType) {
    const char* word = next();
    const ParsedInteger parsed = parse_integer(word, cursor_.end);
    check(word, parsed.end);
    return parsed.value;
  }
  void skip(PlyType, std::uint64_t count) {
    for (; count > 0; --count) {
      next();
      cursor_.word();
    }
  }

 private:
  bool at_line_start(const char* p) const {
    while (p > source_.begin() && is_blank(p[-1])) --p;
    return p == source_.begin() || is_line_end(p[-1]);
  }
  const char* next() {
    cursor_.skip_space();
    if (cursor_.at_end()) throw EndOfData();
    return cursor_.at;
  }
  void check(const char* word, const char* stop) {
    if (stop == nullptr || (stop < cursor_.end && !is_space(*stop))) {
      const std::string text = source_.quote(word);
      const bool comma = text.find(',') != std::string::npos;
      source_.fail(word, fmt::format("bad number {}{}", text, comma ? " (decimal comma?)" : ""));
    }
    cursor_.at = stop;
  }

  MeshSource& source_;
  TextCursor cursor_;
};

template <class Values>
class BodyReader {
 public:
  BodyReader(SoupBuilder& builder, const PlyHeader& header, Values values)
      : builder_(builder), source_(builder.source()), header_(header), values_(std::move(values)) {}

  MeshFile read() {
    for (const PlyElement& element : header_.elements)
      if (element.name == "vertex") announced_vertices_ = element.count;
    std::string ignored;
    for (const PlyElement& element : header_.elements) {
      check_count(element);
      if (element.name == "vertex")
        read_vertices(element);
      else if (element.name == "face")
        read_faces(element);
      else if (element.name == "tristrips")
        read_strips(element);
      else {
        skip_element(element);
        if (element.count != 0) ignored += (ignored.empty() ? "" : ", ") + element.plural();
      }
      if (cut_) break;
    }
    values_.skip_padding();
    if (!cut_ && remaining() != 0)
      builder_.warn(fmt::format("{}: {} after the last announced element ignored",
                                source_.place(values_.at()), bytes_text(double(remaining()))));
    if (!ignored.empty())
      builder_.warn(fmt::format("{}: {} ignored", source_.name(), printable(ignored, 100)));
    return builder_.finish("ply", "PLY");
  }

 private:
  std::uint64_t remaining() const { return static_cast<std::uint64_t>(source_.end() - values_.at()); }

  // Refuses counts that the rest of the file cannot hold, before anything is reserved for them.
  void check_count(const PlyElement& element) {
    const std::uint64_t least = element.least_bytes(header_.encoding);
    // The last value of a text needs no space behind it.
    const std::uint64_t have = remaining() + (header_.encoding == PlyEncoding::ascii ? 1 : 0);
    if (least == 0 || element.count <= have / least) return;
    const char* at = element.at;
    const std::string reason =
        fmt::format("announces {} {} ({}) but the file has {} left for them", element.count, element.plural(),
                    bytes_text(double(element.count) * double(least)), bytes_text(double(remaining())));
    if (!builder_.options().salvage) {
      source_.set_binary(false);
      source_.fail(at, reason);
    }
  }

  // Calls read_one() for each instance. When the data ends too early: an error, or the end of reading.
  template <class ReadOne>
  void for_each(const PlyElement& element, ReadOne read_one) {
    if (element.properties.empty()) return; // nothing in the body, whatever the count
    for (std::uint64_t i = 0; i < element.count; ++i) {
      if (i % 16384 == 0) check_cancel();
      const char* begin = values_.at();
      try {
        values_.begin_instance();
        begin = values_.at();
        read_one(begin);
      } catch (const EndOfData&) {
        cut_ = true;
        return builder_.truncated(begin, fmt::format("{} {} announced, data ends in {} {}", element.count,
                                                     element.plural(), printable(element.name, 40), i + 1));
      }
    }
  }

  void skip_property(const PlyProperty& property) {
    values_.skip(property.type, property.is_list ? read_list_count(property) : 1);
  }

  std::uint64_t read_list_count(const PlyProperty& property) {
    const char* at = values_.at();
    const std::int64_t count = values_.integer(property.count_type);
    if (count < 0) source_.fail(at, fmt::format("list of {} values", count));
    return static_cast<std::uint64_t>(count);
  }

  void skip_element(const PlyElement& element) {
    for_each(element, [&](const char*) {
      for (const PlyProperty& property : element.properties) skip_property(property);
    });
  }

  void read_vertices(const PlyElement& element) {
    // Per property: which coordinate it is, or 3.
    std::vector<int> axes;
    int found = 0;
    for (const PlyProperty& property : element.properties) {
      const int axis = property.name == "x" ? 0 : property.name == "y" ? 1 : property.name == "z" ? 2 : 3;
      axes.push_back(property.is_list ? 3 : axis);
      if (axes.back() < 3) ++found;
    }
    if (found < 3 && element.count != 0) {
      source_.set_binary(false);
      source_.fail(element.at, "element vertex lacks one of the properties x, y, z");
    }
    const std::uint64_t least = std::max<std::uint64_t>(element.least_bytes(header_.encoding), 1);
    builder_.reserve(std::min(element.count, remaining() / least + 1), 0);
    for_each(element, [&](const char* at) {
      double xyz[4] = {0, 0, 0, 0};
      for (std::size_t k = 0; k < axes.size(); ++k) {
        const PlyProperty& property = element.properties[k];
        if (axes[k] < 3)
          xyz[axes[k]] = values_.number(property.type);
        else
          skip_property(property);
      }
      builder_.add_vertex(xyz[0], xyz[1], xyz[2], at);
    });
  }

  std::size_t index_property(const PlyElement& element) {
    for (std::size_t k = 0; k < element.properties.size(); ++k) {
      const PlyProperty& property = element.properties[k];
      if (property.name != "vertex_indices" && property.name != "vertex_index") continue;
      source_.set_binary(false);
      if (!property.is_list) source_.fail(element.at, "vertex indices of faces are no list");
      if (!is_integer(property.type)) source_.fail(element.at, "vertex indices of faces are not integers");
      source_.set_binary(header_.encoding != PlyEncoding::ascii);
      return k;
    }
    if (element.count == 0) return element.properties.size();
    source_.set_binary(false);
    source_.fail(element.at, fmt::format("element {} has no list property vertex_indices", element.name));
  }

  std::uint64_t read_index(const PlyProperty& property, const char* at) {
    const std::int64_t index = values_.integer(property.type);
    if (index < 0 || static_cast<std::uint64_t>(index) >= announced_vertices_)
      source_.fail(at, fmt::format("vertex index {}, file has {} vertices", index, announced_vertices_));
    return static_cast<std::uint64_t>(index);
  }

  void read_faces(const PlyElement& element) {
    const std::size_t list = index_property(element);
    if (list == element.properties.size()) return;
    const PlyProperty& indices = element.properties[list];
    const std::uint64_t typical =
        header_.encoding == PlyEncoding::ascii
            ? 8
            : element.least_bytes(header_.encoding) + 3 * ply_type_size(indices.type);
    builder_.reserve(0, std::min(element.count, remaining() / typical + 1));
    std::vector<std::uint64_t> corners;
    for_each(element, [&](const char* at) {
      for (std::size_t k = 0; k < element.properties.size(); ++k) {
        if (k != list) {
          skip_property(element.properties[k]);
          continue;
        }
        const char* count_at = values_.at();
        const std::uint64_t count = read_list_count(indices);
        if (count > max_polygon_corners)
          source_.fail(count_at,
                       fmt::format("polygon with {} corners exceeds limit {}", count, max_polygon_corners));
        corners.clear();
        for (std::uint64_t i = 0; i < count; ++i) corners.push_back(read_index(indices, values_.at()));
      }
      builder_.add_polygon(corners, at);
    });
  }

  // Strips of triangles, each turned as the first: corners i, i+1, i+2 for even i, i+1, i, i+2 for odd ones.
  // A negative index ends a strip (Stanford's scans keep all of them in one list).
  void read_strips(const PlyElement& element) {
    const std::size_t list = index_property(element);
    if (list == element.properties.size()) return;
    const PlyProperty& indices = element.properties[list];
    for_each(element, [&](const char*) {
      for (std::size_t k = 0; k < element.properties.size(); ++k) {
        if (k != list) {
          skip_property(element.properties[k]);
          continue;
        }
        const std::uint64_t count = read_list_count(indices);
        std::uint64_t length = 0;
        std::uint32_t a = 0, b = 0;
        for (std::uint64_t i = 0; i < count; ++i) {
          const char* at = values_.at();
          const std::int64_t index = values_.integer(indices.type);
          if (index < 0) {
            length = 0;
            continue;
          }
          if (static_cast<std::uint64_t>(index) >= builder_.vertex_count())
            source_.fail(at, fmt::format("vertex index {} of a strip, file has {} vertices before it", index,
                                         builder_.vertex_count()));
          const std::uint32_t c = static_cast<std::uint32_t>(index);
          if (length >= 2) {
            if (length % 2 == 0)
              builder_.add_strip_triangle(a, b, c);
            else
              builder_.add_strip_triangle(b, a, c);
          }
          a = b;
          b = c;
          ++length;
        }
      }
    });
  }

  SoupBuilder& builder_;
  MeshSource& source_;
  const PlyHeader& header_;
  Values values_;
  std::uint64_t announced_vertices_ = 0;
  bool cut_ = false;
};

} // namespace

MeshFile read_ply(SoupBuilder& builder) {
  MeshSource& source = builder.source();
  const PlyHeader header = read_ply_header(source);
  if (header.encoding == PlyEncoding::ascii)
    return BodyReader<TextValues>(builder, header, TextValues(source, header.body)).read();
  const bool big = header.encoding == PlyEncoding::big_endian;
  return BodyReader<BinaryValues>(builder, header, BinaryValues(source, header.body, big)).read();
}

} // namespace levelray
