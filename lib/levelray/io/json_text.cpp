#include "levelray/io/json_text.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <utility>

namespace levelray {

namespace {

constexpr std::size_t line_width = 100; // lists and objects that fit stay on one line

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text)
    if (c == '"' || c == '\\')
      out += {'\\', c};
    else if (c == '\n')
      out += "\\n";
    else if (static_cast<unsigned char>(c) < 0x20)
      out += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
    else
      out += c;
  return out + "\"";
}

bool is_plain(const JsonValue& value) {
  return value.kind != JsonValue::Kind::array && value.kind != JsonValue::Kind::object;
}

// On one line; `space` after colons and commas.
std::string one_line(const JsonValue& value, const std::string& space) {
  switch (value.kind) {
  case JsonValue::Kind::null:
    return "null";
  case JsonValue::Kind::boolean:
    return value.boolean ? "true" : "false";
  case JsonValue::Kind::number: // {} writes the shortest decimal that reads back as the same double
    return fmt::format("{}", value.number);
  case JsonValue::Kind::string:
    return quoted(value.string);
  case JsonValue::Kind::array: {
    std::string out;
    for (const JsonValue& item : value.items) out += (out.empty() ? "" : "," + space) + one_line(item, space);
    return "[" + out + "]";
  }
  case JsonValue::Kind::object: {
    std::string out;
    for (const JsonMember& member : value.members)
      out +=
          (out.empty() ? "" : "," + space) + quoted(member.key) + ":" + space + one_line(member.value, space);
    return out.empty() ? "{}" : "{" + space + out + space + "}";
  }
  }
  return "";
}

// Whether the value may stand on one line: a list of plain values, or an object of those.
bool is_flat(const JsonValue& value) {
  const auto plain_list = [](const JsonValue& v) {
    return is_plain(v) ||
           (v.kind == JsonValue::Kind::array && std::all_of(v.items.begin(), v.items.end(), is_plain));
  };
  return plain_list(value) ||
         (value.kind == JsonValue::Kind::object &&
          std::all_of(value.members.begin(), value.members.end(),
                      [&](const JsonMember& member) { return plain_list(member.value); }));
}

std::string indented(const JsonValue& value, std::size_t level) {
  if (const std::string line = one_line(value, " ");
      is_plain(value) || (is_flat(value) && 2 * level + line.size() < line_width && level > 0))
    return line;
  const std::string indent(2 * level + 2, ' '), end = "\n" + std::string(2 * level, ' ');
  std::string out;
  for (const JsonValue& item : value.items)
    out += (out.empty() ? "\n" : ",\n") + indent + indented(item, level + 1);
  for (const JsonMember& member : value.members)
    out +=
        (out.empty() ? "\n" : ",\n") + indent + quoted(member.key) + ": " + indented(member.value, level + 1);
  const bool list = value.kind == JsonValue::Kind::array;
  return (list ? "[" : "{") + out + (out.empty() ? "" : end) + (list ? "]" : "}");
}

} // namespace

JsonValue JsonValue::array(std::vector<JsonValue> items) {
  JsonValue value;
  value.kind = Kind::array;
  value.items = std::move(items);
  return value;
}

JsonValue JsonValue::object(std::vector<JsonMember> members) {
  JsonValue value;
  value.kind = Kind::object;
  value.members = std::move(members);
  return value;
}

const JsonValue* JsonValue::find(const std::string& key) const {
  for (const JsonMember& member : members)
    if (member.key == key) return &member.value;
  return nullptr;
}

JsonValue* JsonValue::find(const std::string& key) {
  return const_cast<JsonValue*>(std::as_const(*this).find(key));
}

JsonValue& JsonValue::set(const std::string& key, JsonValue value) {
  if (JsonValue* old = find(key)) return *old = std::move(value);
  members.push_back({key, std::move(value), 0});
  return members.back().value;
}

bool operator==(const JsonValue& a, const JsonValue& b) {
  return a.kind == b.kind && a.boolean == b.boolean && a.number == b.number && a.string == b.string &&
         a.items == b.items &&
         std::equal(
             a.members.begin(), a.members.end(), b.members.begin(), b.members.end(),
             [](const JsonMember& x, const JsonMember& y) { return x.key == y.key && x.value == y.value; });
}

const char* kind_text(JsonValue::Kind kind) {
  constexpr const char* texts[] = {"null", "true or false", "a number", "a text", "a list", "an object"};
  return texts[static_cast<int>(kind)];
}

std::string json_text(const JsonValue& value) {
  return indented(value, 0);
}

std::string compact_json_text(const JsonValue& value) {
  return one_line(value, "");
}

} // namespace levelray
