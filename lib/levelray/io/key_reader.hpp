// Reads structs with a `describe` (key_rule.hpp) from JSON, and says where a file breaks the rules.
#pragma once

#include "levelray/io/json_text.hpp"
#include "levelray/io/key_rule.hpp"

namespace levelray {

// "shot.json:7", or what the value's origin says.
std::string place_of(const std::string& file, const JsonValue& value);

// Throws Error(usage) "place: path: reason"; without "path: " when the path is empty.
[[noreturn]] void refuse_value(const std::string& file, const JsonValue& value, const std::string& path,
                               const std::string& reason);

// Takes the keys that a struct describes from an object. Throws Error(usage), one line with the place, for
// unknown and missing keys and for values that break their rule.
class KeyReader {
 public:
  // `path` names the object in messages ("objects[1].material"); empty: the whole file.
  KeyReader(const std::string& file, const JsonValue& object, std::string path)
      : file_(file), object_(object), path_(std::move(path)) {}

  template <class T>
  void key(const char* name, T& value, const Rule& rule, const char*) {
    if (const JsonValue* found = take(name, rule.required)) read(*found, path_of(name), value, rule);
  }
  // The key that decides about the others.
  void kind(std::string& value, const std::vector<std::string>& names, const char*);
  // Exactly one of these keys must be there.
  void one_of(const std::vector<std::string>& names) { one_of_ = names; }
  // What the rules of single keys cannot say; `name`: the key to blame.
  void require(bool good, const char* name, const char* reason);
  // To be called after all keys: complains about the rest.
  void finish() const;

  // "shot.json:7" of a key that is there, else of the object.
  std::string place(const char* name = nullptr) const;

 private:
  std::string path_of(const char* name) const { return path_.empty() ? name : path_ + "." + name; }
  const JsonValue* take(const char* name, bool required);

  void read(const JsonValue& from, const std::string& path, bool& value, const Rule& rule);
  void read(const JsonValue& from, const std::string& path, int& value, const Rule& rule);
  void read(const JsonValue& from, const std::string& path, double& value, const Rule& rule);
  void read(const JsonValue& from, const std::string& path, std::string& value, const Rule& rule);
  void read(const JsonValue& from, const std::string& path, Vec3d& value, const Rule& rule);
  void read(const JsonValue& from, const std::string& path, std::array<int, 2>& value, const Rule& rule);
  void read(const JsonValue& from, const std::string& path, std::vector<std::string>& value,
            const Rule& rule);

  template <class T>
  void read(const JsonValue& from, const std::string& path, std::optional<T>& value, const Rule& rule) {
    read(from, path, value.emplace(), rule);
  }
  template <class T>
  void read(const JsonValue& from, const std::string& path, std::vector<T>& value, const Rule& rule) {
    check_kind(from, path, JsonValue::Kind::array, wanted_text(&value, rule));
    if (from.items.size() < rule.least_items) refuse_value(file_, from, path, "must not be empty");
    value.clear();
    for (std::size_t i = 0; i < from.items.size(); ++i)
      read(from.items[i], path + "[" + std::to_string(i) + "]", value.emplace_back(), Rule());
  }
  template <class T>
  void read(const JsonValue& from, const std::string& path, T& value, const Rule&) {
    check_kind(from, path, JsonValue::Kind::object, "an object");
    KeyReader reader(file_, from, path);
    describe(reader, value);
    reader.finish();
    if constexpr (requires { value.place = std::string(); }) value.place = reader.place();
  }
  void check_kind(const JsonValue& from, const std::string& path, JsonValue::Kind kind,
                  const std::string& wanted) const;

  const std::string& file_;
  const JsonValue& object_;
  const std::string path_;
  std::vector<std::string> known_, one_of_;
  std::string missing_;          // the first required key that is not there
  const char* broken_ = nullptr; // the key of the first broken requirement
  std::string broken_reason_;
};

} // namespace levelray
