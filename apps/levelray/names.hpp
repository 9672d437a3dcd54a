// Names that the user typed, checked against the legal ones.
#pragma once

#include "levelray/core/nearest_name.hpp"

#include <string>
#include <vector>

namespace levelray {

// The index of `typed` in `names`. Throws Error(usage) that lists the legal names and suggests the nearest.
std::size_t find_name(const std::string& option, const std::string& typed,
                      const std::vector<std::string>& names);

// The pieces of "a,b,c".
std::vector<std::string> split_list(const std::string& text);

// "a, b, c".
std::string join(const std::vector<std::string>& names);

} // namespace levelray
