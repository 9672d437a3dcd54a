// Making triangles agree on which side is out.
#pragma once

#include "levelray/mesh/edge_table.hpp"

#include <utility>

namespace levelray {

// A shell is connected over edges, whatever the number of their triangles. Each triangle's shell, numbered by
// lowest triangle, and how many there are.
std::pair<std::vector<std::uint32_t>, std::uint32_t> find_shells(std::size_t triangle_count,
                                                                 const EdgeTable& edges);

struct Consistency {
  std::vector<std::uint8_t> flip; // per triangle: 1 to turn
  std::uint64_t flips = 0;
  bool orientable = true; // no patch is one-sided
};

// Finds the triangles to turn for a consistent orientation. A patch is connected over edges with exactly two
// triangles. Within a patch orientation is propagated and the side that holds more area wins; a one-sided
// patch (Moebius strip) is only touched when that leaves fewer clashes. Between patches, at edges with more
// than two triangles, patches are turned while that makes the oriented boundary chain shorter (greedy from
// the largest patch, then single turns until none helps: a local optimum; what is consistent already stays).
Consistency make_consistent(const TriangleMesh& mesh, const EdgeTable& edges);

} // namespace levelray
