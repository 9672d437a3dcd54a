#include "levelray/convert/caps.hpp"

#include <algorithm>
#include <cstddef>
#include <span>
#include <unordered_map>

namespace levelray {

namespace {

// Triangulates the polygon of a path and the edge from its end back to its start, halving the path: path and
// way back stay side by side.
void cap_path(std::span<const std::uint32_t> path, std::vector<Triangle>& out) {
  if (path.size() < 3) return;
  const std::size_t middle = path.size() / 2;
  out.push_back({path.front(), path[middle], path.back()});
  cap_path(path.first(middle + 1), out);
  cap_path(path.subspan(middle), out);
}

} // namespace

std::vector<Triangle> close_boundary(const std::vector<std::array<std::uint32_t, 2>>& edges) {
  // Edges by their first vertex; equal ones in the order given.
  std::vector<std::array<std::uint32_t, 2>> sorted = edges;
  std::stable_sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) { return a[0] < b[0]; });
  std::unordered_map<std::uint32_t, std::size_t> next_edge; // of a vertex: its first unused edge
  for (std::size_t i = sorted.size(); i-- > 0;) next_edge[sorted[i][0]] = i;

  // Walk along unused edges; whenever the walk meets itself it has closed a loop, which is capped and cut
  // off.
  std::vector<Triangle> caps;
  std::vector<std::uint32_t> walk;
  std::unordered_map<std::uint32_t, std::size_t> place; // of the walk's vertices
  for (const auto& first : sorted) {
    walk.assign(1, first[0]);
    place = {{first[0], 0}};
    for (;;) {
      std::size_t& edge = next_edge[walk.back()];
      if (edge >= sorted.size() || sorted[edge][0] != walk.back())
        break; // all used: the walk is back at its start
      const std::uint32_t to = sorted[edge++][1];
      const auto met = place.find(to);
      if (met == place.end()) {
        place[to] = walk.size();
        walk.push_back(to);
        continue;
      }
      const std::size_t start = met->second;
      cap_path(std::span(walk).subspan(start), caps);
      for (std::size_t i = start + 1; i < walk.size(); ++i) place.erase(walk[i]);
      walk.resize(start + 1);
    }
  }
  return caps;
}

} // namespace levelray
