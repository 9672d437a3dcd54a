#include "lengths.hpp"

#include "levelray/core/error.hpp"

#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <optional>

namespace levelray {

namespace {

using Unit = Length::Unit;

struct UnitName {
  const char* name;
  Unit unit;
  double metres; // 0: no fixed size
};
constexpr UnitName unit_names[] = {
    {"mm", Unit::millimetres, 1e-3}, {"cm", Unit::centimetres, 1e-2}, {"m", Unit::metres, 1},
    {"in", Unit::inches, 0.0254},    {"%", Unit::percent, 0},         {"vx", Unit::voxels, 0},
};

double metres_of(Unit unit) {
  for (const UnitName& entry : unit_names)
    if (entry.unit == unit) return entry.metres;
  return 0;
}

[[noreturn]] void refuse(const std::string& option, const std::string& text, const char* reason) {
  throw Error(ErrorKind::usage, fmt::format("{} {}: {}", option, printable(text, 80), reason));
}

} // namespace

bool parse_number(std::string_view text, double* value, std::string_view* rest) {
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), *value);
  if (error != std::errc() || !std::isfinite(*value)) return false;
  *rest = text.substr(static_cast<std::size_t>(end - text.data()));
  return true;
}

Unit parse_unit(const std::string& text) {
  if (text.empty()) return Unit::plain;
  for (const UnitName& entry : unit_names)
    if (entry.metres > 0 && entry.name == text) return entry.unit;
  refuse("--units", text, "choose mm, cm, m or in");
}

Length parse_length(const std::string& option, const std::string& text) {
  constexpr const char* form = "not a length; write a number and nothing, mm, cm, m, in, % or vx";
  Length length;
  std::string_view suffix;
  if (!parse_number(text, &length.value, &suffix)) refuse(option, text, form);
  if (!(length.value > 0)) refuse(option, text, "must be > 0");
  if (suffix.empty()) return length;
  for (const UnitName& entry : unit_names)
    if (suffix == entry.name) {
      length.unit = entry.unit;
      return length;
    }
  refuse(option, text, form);
}

double resolve_length(const std::string& option, const Length& length, const LengthScale& scale) {
  if (length.unit == Unit::plain) return length.value;
  if (length.unit == Unit::percent) return length.value / 100 * scale.diagonal;
  if (length.unit == Unit::voxels) {
    if (!(scale.voxel_size > 0)) throw Error(ErrorKind::usage, option + ": cannot be given in voxels");
    return length.value * scale.voxel_size;
  }
  if (length.unit == scale.input) return length.value;
  const double input = metres_of(scale.input);
  if (!(input > 0))
    throw Error(ErrorKind::usage,
                option +
                    ": the input's unit is not known; say --units mm, cm, m or in, or give a plain number");
  return length.value * metres_of(length.unit) / input;
}

std::uint64_t parse_bytes(const std::string& option, const std::string& text) {
  constexpr const char* form = "not a size; write a number and nothing, kB, MB, GB, TB, KiB, MiB, GiB or TiB";
  double value = 0;
  std::string_view suffix;
  if (!parse_number(text, &value, &suffix)) refuse(option, text, form);
  if (!(value >= 0)) refuse(option, text, "must be >= 0");
  double factor = 1;
  if (!suffix.empty() && suffix != "B") {
    constexpr std::string_view prefixes = "kMGT";
    const bool binary = suffix.size() == 3 && suffix.substr(1) == "iB";
    const char letter = suffix.front() == 'K' && binary ? 'k' : suffix.front();
    const std::size_t power = prefixes.find(letter);
    if (power == std::string_view::npos || (!binary && suffix.substr(1) != "B")) refuse(option, text, form);
    factor = std::pow(binary ? 1024.0 : 1000.0, static_cast<double>(power + 1));
  }
  if (value * factor >= 9.2e18) refuse(option, text, "too large"); // below 2^63, so that the cast is exact
  return static_cast<std::uint64_t>(value * factor);
}

Vec3d parse_vector(const std::string& option, const std::string& text) {
  Vec3d vector;
  std::string_view rest = text;
  for (int i = 0; i < 3; ++i)
    if (!parse_number(rest, &vector[i], &rest) || (i < 2 ? !rest.starts_with(',') : !rest.empty()))
      refuse(option, text, "not three numbers x,y,z");
    else if (i < 2)
      rest.remove_prefix(1);
  return vector;
}

} // namespace levelray
