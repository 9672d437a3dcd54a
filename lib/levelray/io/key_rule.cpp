#include "levelray/io/key_rule.hpp"

#include <fmt/format.h>

namespace levelray {

namespace {

std::string with_range(const std::string& what, const Rule& rule) {
  if (rule.least == rule.most) return fmt::format("the number {}", rule.least);
  const std::string range = range_text(rule);
  return range.empty() ? what : what + " " + range;
}

} // namespace

std::string range_text(const Rule& rule) {
  const Rule widest;
  const bool low = rule.least > widest.least, high = rule.most < widest.most;
  if (low && high && !rule.above_least && !rule.below_most)
    return fmt::format("from {} to {}", rule.least, rule.most);
  std::string text;
  if (low) text = fmt::format("{} {}", rule.above_least ? "above" : "at least", rule.least);
  if (high)
    text += fmt::format("{}{} {}", low ? " and " : "", rule.below_most ? "below" : "at most", rule.most);
  return text;
}

std::string wanted_text(const bool*, const Rule&) {
  return "true or false";
}
std::string wanted_text(const int*, const Rule& rule) {
  return with_range("a whole number", rule);
}
std::string wanted_text(const double*, const Rule& rule) {
  return with_range("a number", rule);
}
std::string wanted_text(const std::string*, const Rule& rule) {
  if (rule.names) return fmt::format("one of {}", fmt::join(*rule.names, ", "));
  return rule.form ? rule.form : "a text";
}
std::string wanted_text(const Vec3d*, const Rule& rule) {
  return with_range("a list of 3 numbers", rule);
}
std::string wanted_text(const std::array<int, 2>*, const Rule& rule) {
  return with_range("a list of 2 whole numbers", rule);
}
std::string wanted_text(const std::vector<std::string>*, const Rule& rule) {
  if (rule.names) return fmt::format("a list of some of {}", fmt::join(*rule.names, ", "));
  return rule.form ? std::string("a list, each ") + rule.form : "a list of texts";
}

} // namespace levelray
