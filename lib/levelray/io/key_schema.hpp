// The JSON Schema (draft 7, https://json-schema.org/draft-07) and the reference of what a struct's `describe`
// (key_rule.hpp) allows.
#pragma once

#include "levelray/io/key_writer.hpp"

namespace levelray {

JsonValue schema_of(const bool*, const Rule& rule);
JsonValue schema_of(const int*, const Rule& rule);
JsonValue schema_of(const double*, const Rule& rule);
JsonValue schema_of(const std::string*, const Rule& rule);
JsonValue schema_of(const Vec3d*, const Rule& rule);
JsonValue schema_of(const std::array<int, 2>*, const Rule& rule);
JsonValue schema_of(const std::vector<std::string>*, const Rule& rule);
template <class T>
JsonValue schema_of(const std::optional<T>*, const Rule& rule);
template <class T>
JsonValue schema_of(const std::vector<T>*, const Rule& rule);
template <class T>
JsonValue schema_of(const T*, const Rule& rule);

// Collects the properties of one struct, of one kind.
class KeySchema {
 public:
  JsonValue properties = JsonValue::object(), required = JsonValue::array(), one_of_keys = JsonValue::array();
  const std::vector<std::string>* kinds = nullptr; // when the struct comes in kinds

  template <class T>
  void key(const char* name, T& value, const Rule& rule, const char* doc) {
    JsonValue schema = schema_of(static_cast<const T*>(nullptr), rule);
    schema.set("description", doc);
    KeyWriter writer; // its one member, if it writes any, is the default
    writer.key(name, value, rule, doc);
    if (const JsonValue* standard = writer.object.find(name);
        standard && !rule.required && standard->kind != JsonValue::Kind::object)
      schema.set("default", *standard);
    properties.set(name, std::move(schema));
    if (rule.required) required.items.push_back(name);
  }
  void kind(std::string& value, const std::vector<std::string>& names, const char* doc) {
    kinds = &names;
    properties.set("kind", JsonValue::object({{"const", value, 0}, {"description", doc, 0}}));
    required.items.push_back("kind");
  }
  void one_of(const std::vector<std::string>& names) {
    for (const std::string& name : names)
      one_of_keys.items.push_back(JsonValue::object({{"required", JsonValue::array({name}), 0}}));
  }
  void require(bool, const char*, const char*) {}

  JsonValue schema() const;
};

// Calls visit(T&, kind name) for a default T, or for one of each of its kinds.
template <class T, class Visit>
void for_each_kind(const Visit& visit) {
  T value;
  KeySchema first;
  describe(first, value);
  if (!first.kinds) return visit(value, std::string());
  if constexpr (requires { value.kind = std::string(); })
    for (const std::string& kind : *first.kinds) {
      T one;
      one.kind = kind;
      visit(one, kind);
    }
}

template <class T>
JsonValue schema_of(const T*, const Rule&) {
  JsonValue kinds = JsonValue::array();
  for_each_kind<T>([&](T& value, const std::string&) {
    KeySchema visitor;
    describe(visitor, value);
    kinds.items.push_back(visitor.schema());
  });
  if (kinds.items.size() == 1) return kinds.items.front();
  return JsonValue::object({{"oneOf", kinds, 0}});
}

template <class T>
JsonValue schema_of(const std::optional<T>*, const Rule& rule) {
  return schema_of(static_cast<const T*>(nullptr), rule);
}

template <class T>
JsonValue schema_of(const std::vector<T>*, const Rule& rule) {
  JsonValue schema = JsonValue::object(
      {{"type", "array", 0}, {"items", schema_of(static_cast<const T*>(nullptr), Rule()), 0}});
  if (rule.least_items > 0) schema.set("minItems", static_cast<double>(rule.least_items));
  return schema;
}

// Rows of the reference: what a struct and all below it may hold.
class KeyTable {
 public:
  struct Row {
    std::string key, wanted, standard, doc;
    std::vector<std::string> kinds; // for which it is there; empty: always

    bool same(const Row& other) const {
      return key == other.key && wanted == other.wanted && standard == other.standard && doc == other.doc;
    }
  };

  KeyTable(std::vector<Row>& rows, std::string path, std::string kind)
      : rows_(rows), path_(std::move(path)), kind_(std::move(kind)) {}

  template <class T>
  void key(const char* name, T& value, const Rule& rule, const char* doc) {
    KeyWriter writer;
    writer.key(name, value, rule, doc);
    row(name, wanted_text(static_cast<const T*>(nullptr), rule), rule.required, writer.object.find(name),
        doc);
    below(path_ + name, static_cast<const T*>(nullptr));
  }
  void kind(std::string&, const std::vector<std::string>& names, const char* doc) {
    row("kind", wanted_text(static_cast<const std::string*>(nullptr), one_of_names(names)), true, nullptr,
        doc);
    kinds_ = names.size();
  }
  void one_of(const std::vector<std::string>&) {}
  void require(bool, const char*, const char*) {}

  // Appends the rows of T, those of its kinds together.
  template <class T>
  static void add(std::vector<Row>& rows, const std::string& path) {
    for_each_kind<T>([&](T& value, const std::string& kind) {
      KeyTable table(rows, path, kind);
      describe(table, value);
    });
  }

  // "| key | holds | default | what |"
  static std::string text(const std::vector<Row>& rows);

 private:
  void row(const std::string& name, const std::string& wanted, bool required, const JsonValue* standard,
           const char* doc);

  template <class T>
  void below(const std::string& path, const std::optional<T>*) {
    below(path, static_cast<const T*>(nullptr));
  }
  template <class T>
  void below(const std::string& path, const std::vector<T>*) {
    below(path + "[]", static_cast<const T*>(nullptr));
  }
  template <class T>
  void below(const std::string& path, const T*) {
    if constexpr (requires(T & value, KeyTable & table) { describe(table, value); })
      add<T>(rows_, path + ".");
  }

  std::vector<Row>& rows_;
  const std::string path_, kind_;
  std::size_t kinds_ = 0;
};

} // namespace levelray
