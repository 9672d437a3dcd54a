// What a key of a JSON file may hold, said once: readers, the JSON Schema and the reference all use it.
//
// A struct T that a file may hold has a function template `describe(visitor, T&)`, which names its keys:
//
//   template <class Visitor>
//   void describe(Visitor& v, Film& film) {
//     v.key("samples", film.samples, whole(1, 1024), "Rays per pixel");
//   }
//
// Visitors: KeyReader (JSON to struct, with errors), KeyWriter (struct to JSON), KeySchema (JSON Schema),
// KeyTable (the reference). Defaults are the values of a default-constructed T.
#pragma once

#include "levelray/core/vec.hpp"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace levelray {

struct Rule {
  double least = -1e12, most = 1e12; // of numbers; lengths beyond would overflow when squared twice
  bool above_least = false, below_most = false;    // the bounds themselves are not allowed
  const std::vector<std::string>* names = nullptr; // the texts that are allowed; null: any
  const char* pattern = nullptr;                   // of texts: an ECMAScript expression for all of it
  const char* form = nullptr;                      // what the pattern means, for messages
  bool required = false;
  std::size_t least_items = 0; // of lists; bytes of texts

  Rule must() const {
    Rule rule = *this;
    rule.required = true;
    return rule;
  }
};

inline Rule any() {
  return {};
}
inline Rule within(double least, double most) {
  return {.least = least, .most = most};
}
inline Rule at_least(double least) {
  return {.least = least};
}
inline Rule above(double least, double most = 1e12) {
  return {.least = least, .most = most, .above_least = true};
}
inline Rule one_of_names(const std::vector<std::string>& names) {
  return {.names = &names};
}
inline Rule text_like(const char* pattern, const char* form) {
  return {.pattern = pattern, .form = form};
}
inline Rule not_empty() {
  return {.least_items = 1};
}

// The longest text that a file may hold where a pattern is checked (std::regex recurses once per character),
// and the longest at all.
inline constexpr std::size_t max_pattern_bytes = 200, max_text_bytes = 4000;

// Whether the number obeys the rule.
inline bool is_legal(double number, const Rule& rule) {
  return (rule.above_least ? number > rule.least : number >= rule.least) &&
         (rule.below_most ? number < rule.most : number <= rule.most);
}

// "from 0 to 1", "above 0", "at least 1", "above 0 and below 180", or "" for the widest range.
std::string range_text(const Rule& rule);

// What such a key holds, in words: "a whole number from 1 to 1024", "3 numbers", "one of a, b, c". Of structs
// and lists of them: "an object", "a list of objects".
std::string wanted_text(const bool*, const Rule& rule);
std::string wanted_text(const int*, const Rule& rule);
std::string wanted_text(const double*, const Rule& rule);
std::string wanted_text(const std::string*, const Rule& rule);
std::string wanted_text(const Vec3d*, const Rule& rule);
std::string wanted_text(const std::array<int, 2>*, const Rule& rule);
std::string wanted_text(const std::vector<std::string>*, const Rule& rule);
template <class T>
std::string wanted_text(const std::optional<T>*, const Rule& rule) {
  return wanted_text(static_cast<const T*>(nullptr), rule);
}
template <class T>
std::string wanted_text(const std::vector<T>*, const Rule& rule) {
  return rule.least_items > 0 ? "a list of one or more objects" : "a list of objects";
}
template <class T>
std::string wanted_text(const T*, const Rule&) {
  return "an object";
}

} // namespace levelray
