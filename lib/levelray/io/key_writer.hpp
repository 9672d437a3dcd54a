// Structs with a `describe` (key_rule.hpp) as JSON.
#pragma once

#include "levelray/io/json_text.hpp"
#include "levelray/io/key_rule.hpp"

namespace levelray {

template <class T>
JsonValue to_json(const T& value);

// Collects a struct's keys as members of an object. Absent optional values, empty lists and empty texts are
// left out.
class KeyWriter {
 public:
  JsonValue object = JsonValue::object();

  template <class T>
  void key(const char* name, T& value, const Rule&, const char*) {
    put(name, value);
  }
  void kind(std::string& value, const std::vector<std::string>&, const char*) { put("kind", value); }
  void one_of(const std::vector<std::string>&) {}
  void require(bool, const char*, const char*) {}

 private:
  template <class T>
  void put(const char* name, const std::optional<T>& value) {
    if (value) put(name, *value);
  }
  template <class T>
  void put(const char* name, const std::vector<T>& value) {
    if (value.empty()) return;
    JsonValue list = JsonValue::array();
    for (const T& item : value) list.items.push_back(json_of(item));
    object.set(name, list);
  }
  void put(const char* name, const std::string& value) {
    if (!value.empty()) object.set(name, value);
  }
  template <class T>
  void put(const char* name, const T& value) {
    object.set(name, json_of(value));
  }

  static JsonValue json_of(bool value) { return value; }
  static JsonValue json_of(int value) { return value; }
  static JsonValue json_of(double value) { return value; }
  static JsonValue json_of(const std::string& value) { return value; }
  static JsonValue json_of(const Vec3d& v) { return JsonValue::array({v.x, v.y, v.z}); }
  static JsonValue json_of(const std::array<int, 2>& v) { return JsonValue::array({v[0], v[1]}); }
  template <class T>
  static JsonValue json_of(const T& value) {
    return to_json(value);
  }
};

// All keys that the struct has, those with default values included.
template <class T>
JsonValue to_json(const T& value) {
  T copy = value; // describe() takes what it may change
  KeyWriter writer;
  describe(writer, copy);
  return std::move(writer.object);
}

} // namespace levelray
