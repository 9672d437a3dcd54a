#include "levelray/io/key_reader.hpp"

#include "levelray/core/error.hpp"
#include "levelray/core/nearest_name.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <regex>

namespace levelray {

namespace {

using Kind = JsonValue::Kind;

// A value as a message shows it.
std::string shown(const JsonValue& value) {
  switch (value.kind) {
  case Kind::boolean:
    return value.boolean ? "true" : "false";
  case Kind::number:
    return fmt::format("{}", value.number);
  case Kind::string:
    return "\"" + printable(value.string, 60) + "\"";
  default:
    return kind_text(value.kind);
  }
}

[[noreturn]] void refuse_wrong(const std::string& file, const JsonValue& value, const std::string& path,
                               const std::string& wanted) {
  refuse_value(file, value, path, fmt::format("must be {}, not {}", printable(wanted, 250), shown(value)));
}

} // namespace

std::string place_of(const std::string& file, const JsonValue& value) {
  return value.origin.empty() ? fmt::format("{}:{}", file, value.line) : value.origin;
}

void refuse_value(const std::string& file, const JsonValue& value, const std::string& path,
                  const std::string& reason) {
  const std::string name = path.empty() ? "" : printable(path, 120) + ": ";
  throw Error(ErrorKind::usage, fmt::format("{}: {}{}", place_of(file, value), name, reason));
}

const JsonValue* KeyReader::take(const char* name, bool required) {
  known_.push_back(name);
  const JsonValue* found = object_.find(name);
  if (!found && required && missing_.empty()) missing_ = name;
  return found;
}

void KeyReader::kind(std::string& value, const std::vector<std::string>& names, const char*) {
  const JsonValue* found = take("kind", true);
  if (!found) {
    // Without it, nothing is known about the other keys.
    for (const JsonMember& member : object_.members)
      if (nearest_name(member.key, {"kind"}) == "kind") finish();
    refuse_value(file_, object_, path_,
                 fmt::format("the key \"kind\" is missing; choose {}", fmt::join(names, ", ")));
  }
  read(*found, path_of("kind"), value, one_of_names(names));
}

void KeyReader::require(bool good, const char* name, const char* reason) {
  if (good || broken_) return;
  broken_ = name;
  broken_reason_ = reason;
}

void KeyReader::finish() const {
  for (const JsonMember& member : object_.members) {
    if (std::find(known_.begin(), known_.end(), member.key) != known_.end()) continue;
    std::string hint = suggestion(member.key, known_);
    if (hint.empty()) hint = fmt::format("; keys here: {}", fmt::join(known_, ", "));
    const std::string place =
        member.value.origin.empty() ? fmt::format("{}:{}", file_, member.line) : member.value.origin;
    throw Error(ErrorKind::usage,
                fmt::format("{}: unknown key \"{}\"{}{}", place, printable(member.key, 60),
                            path_.empty() ? "" : " in " + printable(path_, 100), printable(hint, 250)));
  }
  if (!missing_.empty())
    refuse_value(file_, object_, path_, fmt::format("the key \"{}\" is missing", missing_));
  if (!one_of_.empty()) {
    std::vector<std::string> there;
    for (const std::string& name : one_of_)
      if (object_.find(name)) there.push_back(name);
    if (there.empty())
      refuse_value(file_, object_, path_,
                   fmt::format("one of the keys {} is missing", fmt::join(one_of_, ", ")));
    if (there.size() > 1)
      refuse_value(file_, *object_.find(there[1]), path_,
                   fmt::format("only one of the keys {} may be there", fmt::join(there, ", ")));
  }
  if (broken_) {
    const JsonValue* blamed = object_.find(broken_);
    refuse_value(file_, blamed ? *blamed : object_, path_of(broken_), broken_reason_);
  }
}

std::string KeyReader::place(const char* name) const {
  const JsonValue* value = name ? object_.find(name) : nullptr;
  return place_of(file_, value ? *value : object_);
}

void KeyReader::check_kind(const JsonValue& from, const std::string& path, Kind kind,
                           const std::string& wanted) const {
  if (from.kind != kind) refuse_wrong(file_, from, path, wanted);
}

void KeyReader::read(const JsonValue& from, const std::string& path, bool& value, const Rule& rule) {
  check_kind(from, path, Kind::boolean, wanted_text(&value, rule));
  value = from.boolean;
}

void KeyReader::read(const JsonValue& from, const std::string& path, int& value, const Rule& rule) {
  check_kind(from, path, Kind::number, wanted_text(&value, rule));
  // Written so that what an int cannot hold fails before the cast.
  if (!is_legal(from.number, rule) || !(std::abs(from.number) < 2147483648.0) ||
      from.number != std::floor(from.number))
    refuse_wrong(file_, from, path, wanted_text(&value, rule));
  value = static_cast<int>(from.number);
}

void KeyReader::read(const JsonValue& from, const std::string& path, double& value, const Rule& rule) {
  check_kind(from, path, Kind::number, wanted_text(&value, rule));
  if (!is_legal(from.number, rule)) refuse_wrong(file_, from, path, wanted_text(&value, rule));
  value = from.number;
}

void KeyReader::read(const JsonValue& from, const std::string& path, std::string& value, const Rule& rule) {
  check_kind(from, path, Kind::string, wanted_text(&value, rule));
  const std::string& text = from.string;
  if (rule.names && std::find(rule.names->begin(), rule.names->end(), text) == rule.names->end())
    refuse_value(file_, from, path,
                 fmt::format("must be {}, not \"{}\"{}", wanted_text(&value, rule), printable(text, 60),
                             suggestion(text, *rule.names)));
  if (text.size() > (rule.pattern ? max_pattern_bytes : max_text_bytes) ||
      text.find('\0') != std::string::npos)
    refuse_value(file_, from, path, "too long, or holds a zero character");
  if (text.size() < rule.least_items) refuse_value(file_, from, path, "must not be empty");
  if (rule.pattern && !std::regex_match(text, std::regex(rule.pattern)))
    refuse_wrong(file_, from, path, wanted_text(&value, rule));
  value = text;
}

void KeyReader::read(const JsonValue& from, const std::string& path, Vec3d& value, const Rule& rule) {
  if (from.kind != Kind::array || from.items.size() != 3)
    refuse_wrong(file_, from, path, wanted_text(&value, rule));
  for (int i = 0; i < 3; ++i)
    read(from.items[static_cast<std::size_t>(i)], fmt::format("{}[{}]", path, i), value[i], rule);
}

void KeyReader::read(const JsonValue& from, const std::string& path, std::array<int, 2>& value,
                     const Rule& rule) {
  if (from.kind != Kind::array || from.items.size() != 2)
    refuse_wrong(file_, from, path, wanted_text(&value, rule));
  for (std::size_t i = 0; i < 2; ++i) read(from.items[i], fmt::format("{}[{}]", path, i), value[i], rule);
}

void KeyReader::read(const JsonValue& from, const std::string& path, std::vector<std::string>& value,
                     const Rule& rule) {
  check_kind(from, path, Kind::array, wanted_text(&value, rule));
  if (from.items.size() < rule.least_items) refuse_value(file_, from, path, "must not be empty");
  value.clear();
  for (std::size_t i = 0; i < from.items.size(); ++i)
    read(from.items[i], fmt::format("{}[{}]", path, i), value.emplace_back(), rule);
}

} // namespace levelray
