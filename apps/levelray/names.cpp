#include "names.hpp"

#include "levelray/core/error.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace levelray {

std::size_t find_name(const std::string& option, const std::string& typed,
                      const std::vector<std::string>& names) {
  const auto found = std::find(names.begin(), names.end(), typed);
  if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
  throw Error(ErrorKind::usage, fmt::format("{} \"{}\" is unknown; choose from {}{}", option,
                                            printable(typed, 60), join(names), suggestion(typed, names)));
}

std::vector<std::string> split_list(const std::string& text) {
  std::vector<std::string> pieces;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    pieces.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return pieces;
}

std::string join(const std::vector<std::string>& names) {
  return fmt::format("{}", fmt::join(names, ", "));
}

} // namespace levelray
