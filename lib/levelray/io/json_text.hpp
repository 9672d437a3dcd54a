// JSON files that people write by hand: values that know the line they stand on, and errors that say it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace levelray {

struct JsonMember;

// A JSON value (RFC 8259). Members keep the file's order; no key occurs twice.
struct JsonValue {
  enum class Kind : std::uint8_t { null, boolean, number, string, array, object };

  Kind kind = Kind::null;
  bool boolean = false;
  int line = 0;       // where it begins, from 1; 0: not from a file
  double number = 0;  // finite
  std::string string; // UTF-8
  std::vector<JsonValue> items;
  std::vector<JsonMember> members;
  std::string origin; // when not from a file: what messages name instead, e.g. "--set film.samples=4"

  JsonValue();
  JsonValue(bool value);
  JsonValue(double value);
  JsonValue(int value);
  JsonValue(std::string value);
  JsonValue(const char* value);
  static JsonValue array();
  static JsonValue array(std::vector<JsonValue> items);
  static JsonValue object();
  static JsonValue object(std::vector<JsonMember> members);

  const JsonValue* find(const std::string& key) const; // of an object; null: no such member
  JsonValue* find(const std::string& key);
  JsonValue& set(const std::string& key, JsonValue value); // adds or replaces a member
};

struct JsonMember {
  std::string key;
  JsonValue value;
  int line = 0; // of the key
};

// Here and not above, where members are of a type not yet complete.
inline JsonValue::JsonValue() = default;
inline JsonValue::JsonValue(bool value) : kind(Kind::boolean), boolean(value) {}
inline JsonValue::JsonValue(double value) : kind(Kind::number), number(value) {}
inline JsonValue::JsonValue(int value) : JsonValue(static_cast<double>(value)) {}
inline JsonValue::JsonValue(std::string value) : kind(Kind::string), string(std::move(value)) {}
inline JsonValue::JsonValue(const char* value) : JsonValue(std::string(value)) {}
inline JsonValue JsonValue::array() {
  return array({});
}
inline JsonValue JsonValue::object() {
  return object({});
}

// Compares values, not places.
bool operator==(const JsonValue& a, const JsonValue& b);

// "null", "true or false", "a number", "a text", "a list", "an object".
const char* kind_text(JsonValue::Kind kind);

// Files beyond these are refused: nobody means them, and recursion over values stays shallow.
inline constexpr std::size_t max_json_bytes = std::size_t{16} << 20;
inline constexpr std::size_t max_json_values = 1'000'000;
inline constexpr std::size_t max_json_depth = 32;

// Parses a whole text; `name` stands for the file in messages. Throws Error(usage) "name:line: reason; hint",
// and "name:line:column: ..." for what is no JSON: syntax, numbers beyond double, bytes that are no UTF-8,
// keys that occur twice, and more than the limits above.
JsonValue parse_json(const std::string& text, const std::string& name);

// The value as text that people can read and edit: two spaces per level, lists of plain values and small
// objects on one line, numbers by the fewest digits that give the same double. Ends without a newline.
std::string json_text(const JsonValue& value);
// The same on one line without spaces, for comparing and hashing.
std::string compact_json_text(const JsonValue& value);

} // namespace levelray
