#include "levelray/io/key_schema.hpp"

#include <fmt/format.h>

namespace levelray {

namespace {

JsonValue typed(const char* type) {
  return JsonValue::object({{"type", type, 0}});
}

JsonValue number_schema(const char* type, const Rule& rule) {
  JsonValue schema = typed(type);
  const Rule widest;
  if (rule.least > widest.least) schema.set(rule.above_least ? "exclusiveMinimum" : "minimum", rule.least);
  if (rule.most < widest.most) schema.set(rule.below_most ? "exclusiveMaximum" : "maximum", rule.most);
  return schema;
}

JsonValue list_of(JsonValue item, int count) {
  JsonValue schema = typed("array");
  schema.set("items", std::move(item));
  schema.set("minItems", count);
  schema.set("maxItems", count);
  return schema;
}

} // namespace

JsonValue schema_of(const bool*, const Rule&) {
  return typed("boolean");
}
JsonValue schema_of(const int*, const Rule& rule) {
  return number_schema("integer", rule);
}
JsonValue schema_of(const double*, const Rule& rule) {
  return number_schema("number", rule);
}
JsonValue schema_of(const std::string*, const Rule& rule) {
  JsonValue schema = typed("string");
  if (rule.names) {
    JsonValue names = JsonValue::array();
    for (const std::string& name : *rule.names) names.items.push_back(name);
    schema.set("enum", names);
  }
  if (rule.least_items > 0) schema.set("minLength", static_cast<double>(rule.least_items));
  if (rule.pattern) schema.set("pattern", std::string("^(") + rule.pattern + ")$");
  return schema;
}
JsonValue schema_of(const Vec3d*, const Rule& rule) {
  return list_of(number_schema("number", rule), 3);
}
JsonValue schema_of(const std::array<int, 2>*, const Rule& rule) {
  return list_of(number_schema("integer", rule), 2);
}
JsonValue schema_of(const std::vector<std::string>*, const Rule& rule) {
  JsonValue schema = typed("array");
  schema.set("items", schema_of(static_cast<const std::string*>(nullptr), rule));
  if (rule.least_items > 0) schema.set("minItems", static_cast<double>(rule.least_items));
  return schema;
}

JsonValue KeySchema::schema() const {
  JsonValue schema = typed("object");
  schema.set("properties", properties);
  if (!required.items.empty()) schema.set("required", required);
  if (!one_of_keys.items.empty()) schema.set("oneOf", one_of_keys);
  schema.set("additionalProperties", false);
  return schema;
}

void KeyTable::row(const std::string& name, const std::string& wanted, bool required,
                   const JsonValue* standard, const char* doc) {
  Row row{path_ + name, wanted, required ? "required" : "", doc, {}};
  if (standard && !required && standard->kind != JsonValue::Kind::object)
    row.standard = "`" + compact_json_text(*standard) + "`";
  if (name != "kind" && !kind_.empty()) row.kinds.push_back(kind_);
  for (Row& other : rows_)
    if (other.same(row)) {
      other.kinds.insert(other.kinds.end(), row.kinds.begin(), row.kinds.end());
      if (other.kinds.size() == kinds_) other.kinds.clear(); // of all of them
      return;
    }
  rows_.push_back(std::move(row));
}

std::string KeyTable::text(const std::vector<Row>& rows) {
  std::string text = "| key | holds | default | what |\n|---|---|---|---|\n";
  for (const Row& row : rows)
    text += fmt::format("| `{}`{}{} | {} | {} | {} |\n", row.key, row.kinds.empty() ? "" : " of ",
                        fmt::join(row.kinds, ", "), row.wanted, row.standard, row.doc);
  return text;
}

} // namespace levelray
