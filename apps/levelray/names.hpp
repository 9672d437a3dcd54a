// Names that the user typed, checked against the legal ones.
#pragma once

#include <string>
#include <vector>

namespace levelray {

// The name nearest to `typed` by edit distance (Levenshtein 1966), or "" when none is near enough to be
// meant: at most a third of its letters, and at least one, may differ.
std::string nearest_name(const std::string& typed, const std::vector<std::string>& names);

// "; did you mean "x"?" or "".
std::string suggestion(const std::string& typed, const std::vector<std::string>& names);

// The index of `typed` in `names`. Throws Error(usage) that lists the legal names and suggests the nearest.
std::size_t find_name(const std::string& option, const std::string& typed,
                      const std::vector<std::string>& names);

// The pieces of "a,b,c".
std::vector<std::string> split_list(const std::string& text);

// "a, b, c".
std::string join(const std::vector<std::string>& names);

} // namespace levelray
