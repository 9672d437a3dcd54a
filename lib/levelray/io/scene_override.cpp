#include "levelray/io/scene_override.hpp"

#include "levelray/core/error.hpp"
#include "levelray/core/nearest_name.hpp"

#include <charconv>
#include <fmt/format.h>

namespace levelray {

namespace {

using Kind = JsonValue::Kind;

// Gives the value and all below it the place that messages name.
void set_origin(JsonValue& value, const std::string& origin) {
  value.origin = origin;
  for (JsonValue& item : value.items) set_origin(item, origin);
  for (JsonMember& member : value.members) set_origin(member.value, origin);
}

JsonValue value_of(const std::string& text) {
  try {
    return parse_json(text, "");
  } catch (const Error&) {
    return text; // a bare word
  }
}

// The item of a list that a step names: by index, or by the value of its key "name".
JsonValue& item_of(JsonValue& list, const std::string& step, const std::string& origin) {
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(step.data(), step.data() + step.size(), index);
  if (error == std::errc() && end == step.data() + step.size()) {
    if (index < list.items.size()) return list.items[index];
    throw Error(ErrorKind::usage, fmt::format("{}: there are {} items, counted from 0; none is number {}",
                                              origin, list.items.size(), step));
  }
  std::vector<std::string> names;
  for (JsonValue& item : list.items)
    if (const JsonValue* name = item.find("name"); name && name->kind == Kind::string) {
      if (name->string == step) return item;
      names.push_back(name->string);
    }
  const std::string near = suggestion(step, names);
  throw Error(ErrorKind::usage,
              fmt::format("{}: nothing there is named \"{}\"{}", origin, printable(step, 60),
                          near.empty() ? "; use a name or a number from 0" : printable(near, 100)));
}

} // namespace

void override_value(JsonValue& scene, const std::string& text) {
  const std::string origin = "--set " + printable(text, 120);
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0)
    throw Error(ErrorKind::usage, origin + ": not PATH=VALUE, e.g. film.samples=4");

  JsonValue* at = &scene;
  for (std::size_t begin = 0; begin <= equals;) {
    const std::size_t end = std::min(text.find('.', begin), equals);
    const std::string step = text.substr(begin, end - begin);
    begin = end + 1;
    if (step.empty()) throw Error(ErrorKind::usage, origin + ": the path has an empty step");
    if (at->kind == Kind::array) {
      at = &item_of(*at, step, origin);
    } else if (at->kind == Kind::object) {
      JsonValue* next = at->find(step);
      if (!next) {
        next = &at->set(step, JsonValue::object());
        next->origin = origin;
      }
      at = next;
    } else {
      throw Error(ErrorKind::usage, fmt::format("{}: \"{}\" would be inside of {}, which holds no keys",
                                                origin, printable(step, 60), kind_text(at->kind)));
    }
  }
  *at = value_of(text.substr(equals + 1));
  set_origin(*at, origin);
}

} // namespace levelray
