#include "levelray/core/error.hpp"
#include "levelray/io/json_text.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <iterator>
#include <nlohmann/json.hpp>
#include <unordered_set>

namespace levelray {

namespace {

// Characters for the lexer that tell how far it has come.
class CountingIterator {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  CountingIterator(const char* at, const char** reached) : at_(at), reached_(reached) {}
  reference operator*() const { return *at_; }
  CountingIterator& operator++() {
    *reached_ = ++at_;
    return *this;
  }
  bool operator==(const CountingIterator& other) const { return at_ == other.at_; }
  bool operator!=(const CountingIterator& other) const { return at_ != other.at_; }

 private:
  const char* at_;
  const char** reached_;
};

// What may have been meant where JSON ends, in the words of somebody who writes a scene.
std::string hint(const std::string& text, std::size_t at) {
  const auto is_space = [](char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; };
  if (at >= text.size()) return "the text ends too early; a bracket or quote is not closed";
  const char c = text[at];
  std::size_t before = at;
  while (before > 0 && is_space(text[before - 1])) --before;
  const char previous = before > 0 ? text[before - 1] : '\0';
  if (c == '/' || c == '#') return "JSON has no comments";
  if (c == '\'') return "texts and keys stand in double quotes";
  if ((c == '}' || c == ']') && previous == ',') return fmt::format("no comma before the closing {}", c);
  if (c == ',') return "a comma too many";
  const std::string_view word = std::string_view(text).substr(at, 20);
  for (const char* no_number : {"NaN", "nan", "Inf", "inf", "-Inf", "-inf", "-nan", "-NaN"})
    if (word.starts_with(no_number)) return "a number must be finite";
  if (word.starts_with("True") || word.starts_with("False")) return "write true and false in lower case";
  if (c == '+') return "a number takes no plus sign";
  if (c == '.') return "write 0 before the decimal point";
  if (c == '"' || c == '{' || c == '[') return "a comma is missing before it";
  return "";
}

// Builds the tree. Throws Error where the text is JSON that we refuse.
class TreeBuilder {
 public:
  TreeBuilder(const std::string& text, const std::string& name, const char* const* reached)
      : text_(text), name_(name), reached_(reached) {}

  JsonValue root;

  bool null() { return put(JsonValue()), true; }
  bool boolean(bool value) { return put(JsonValue(value)), true; }
  bool number_integer(std::int64_t value) { return put(JsonValue(static_cast<double>(value))), true; }
  bool number_unsigned(std::uint64_t value) { return put(JsonValue(static_cast<double>(value))), true; }
  bool number_float(double value, const std::string&) { return put(JsonValue(value)), true; }
  bool string(std::string& value) { return put(JsonValue(std::move(value))), true; }
  bool binary(std::vector<std::uint8_t>&) { return false; } // not in JSON text
  bool start_object(std::size_t) { return open(JsonValue::object()), true; }
  bool start_array(std::size_t) { return open(JsonValue::array()), true; }
  bool end_object() { return open_.pop_back(), true; }
  bool end_array() { return open_.pop_back(), true; }

  bool key(std::string& key) {
    Open& object = open_.back();
    if (!object.keys.insert(key).second)
      fail(fmt::format("key \"{}\" occurs twice in this object", printable(key, 80)));
    object.value->members.push_back({std::move(key), JsonValue(), line()});
    return true;
  }

  bool parse_error(std::size_t position, const std::string&, const nlohmann::detail::exception& error) {
    // `position` counts what was read, the unexpected byte included; tokens end there, so go to their start.
    std::size_t at = std::min(position > 0 ? position - 1 : 0, text_.size());
    const std::string what = error.what();
    if (what.find("number overflow") != std::string::npos) fail("a number is too large for a double");
    if (position > text_.size()) at = text_.size();
    while (at > 0 && at < text_.size() && is_word(text_[at]) && is_word(text_[at - 1])) --at;
    if (at > 0 && at < text_.size() && text_[at] == '"' && what.find("invalid") == std::string::npos)
      at = std::min(at, text_.rfind('"', at - 1)); // a whole text that is not expected here
    const std::size_t line_begin = at == 0 ? 0 : text_.rfind('\n', at - 1) + 1; // npos + 1 is 0
    const auto lines = 1 + std::count(text_.begin(), text_.begin() + static_cast<std::ptrdiff_t>(at), '\n');
    std::string reason = what.find("UTF-8") != std::string::npos ? "not UTF-8 text" : "not JSON";
    if (what.find("must be escaped") != std::string::npos)
      reason = "a text holds a line break or control character; is a quote missing?";
    else if (const std::string meant = hint(text_, at); !meant.empty())
      reason += ": " + meant;
    else
      reason += fmt::format(": unexpected \"{}\"", word_at(at));
    throw Error(ErrorKind::usage, fmt::format("{}:{}:{}: {}", name_, lines, at - line_begin + 1, reason));
  }

 private:
  struct Open {
    JsonValue* value;
    std::unordered_set<std::string> keys;
  };

  static bool is_word(char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '-' ||
           c == '+' || c == '.' || c == '_';
  }

  std::string word_at(std::size_t at) const {
    std::size_t end = at + 1;
    while (end < text_.size() && end < at + 40 && is_word(text_[at]) && is_word(text_[end])) ++end;
    return printable(text_.substr(at, end - at), 40);
  }

  // Of the last token: the lexer is at most one byte beyond it.
  int line() {
    const char* at = *reached_;
    while (at > text_.data() && (at[-1] == ' ' || at[-1] == '\t' || at[-1] == '\n' || at[-1] == '\r')) --at;
    if (at < counted_) return line_; // back over a line break that was counted already: not by one token
    line_ += static_cast<int>(std::count(counted_, at, '\n'));
    counted_ = at;
    return line_;
  }

  [[noreturn]] void fail(const std::string& reason) {
    throw Error(ErrorKind::usage, fmt::format("{}:{}: {}", name_, line(), reason));
  }

  // Gives the value its place in the innermost open value.
  JsonValue* put(JsonValue&& value) {
    value.line = line();
    if (++values_ > max_json_values) fail(fmt::format("more than {} values", max_json_values));
    JsonValue* place = &root;
    if (!open_.empty()) {
      JsonValue& parent = *open_.back().value;
      place =
          parent.kind == JsonValue::Kind::array ? &parent.items.emplace_back() : &parent.members.back().value;
    }
    *place = std::move(value);
    return place;
  }

  // Pointers to open values stay valid: only the innermost one grows.
  void open(JsonValue&& value) {
    if (open_.size() == max_json_depth)
      fail(fmt::format("lists and objects nest more than {} deep", max_json_depth));
    open_.push_back({put(std::move(value)), {}});
  }

  const std::string& text_;
  const std::string& name_;
  const char* const* reached_;
  const char* counted_ = text_.data();
  int line_ = 1;
  std::size_t values_ = 0;
  std::vector<Open> open_;
};

} // namespace

JsonValue parse_json(const std::string& text, const std::string& name) {
  if (text.size() > max_json_bytes)
    throw Error(ErrorKind::usage,
                fmt::format("{}: larger than {} MiB; is this a scene?", name, max_json_bytes >> 20));
  if (const std::size_t zero = text.find('\0'); zero != std::string::npos)
    throw Error(ErrorKind::usage,
                fmt::format("{}@{}: holds a zero byte; JSON is plain UTF-8 text", name, zero));
  const char* reached = text.data();
  const char* end = text.data() + text.size();
  TreeBuilder builder(text, name, &reached);
  if (!nlohmann::json::sax_parse(CountingIterator(text.data(), &reached), CountingIterator(end, &reached),
                                 &builder))
    throw Error(ErrorKind::usage, name + ": not JSON");
  return std::move(builder.root);
}

} // namespace levelray
