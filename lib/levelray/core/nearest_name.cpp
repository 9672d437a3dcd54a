#include "levelray/core/nearest_name.hpp"

#include <algorithm>
#include <numeric>

namespace levelray {

namespace {

// Optimal string alignment (Damerau 1964): letters inserted, left out, replaced, or swapped with the next
// one.
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    before.swap(last);
    last.swap(row);
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1), last[j] + 1, row[j - 1] + 1});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        row[j] = std::min(row[j], before[j - 2] + 1);
    }
  }
  return row.back();
}

} // namespace

std::string nearest_name(const std::string& typed, const std::vector<std::string>& names) {
  std::string nearest;
  std::size_t least = typed.size() > 200 ? 0 : std::max<std::size_t>(typed.size() / 3, 1) + 1;
  for (const std::string& name : names)
    if (const std::size_t distance = least > 0 ? edit_distance(typed, name) : 0; distance < least) {
      least = distance;
      nearest = name;
    }
  return nearest;
}

std::string suggestion(const std::string& typed, const std::vector<std::string>& names) {
  const std::string nearest = nearest_name(typed, names);
  return nearest.empty() ? "" : "; did you mean \"" + nearest + "\"?";
}

} // namespace levelray
