// What a misspelled name was probably meant to be.
#pragma once

#include <string>
#include <vector>

namespace levelray {

// The name nearest to `typed` by edit distance (a swap of neighbours counts once; Damerau 1964), or "" when
// none is near enough to be meant: at most a third of its letters, and at least one, may differ.
std::string nearest_name(const std::string& typed, const std::vector<std::string>& names);

// "; did you mean "x"?" or "".
std::string suggestion(const std::string& typed, const std::vector<std::string>& names);

} // namespace levelray
