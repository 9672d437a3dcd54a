// Triangles over the same three vertices: which to drop, thinking of the oriented boundary of the mesh as a
// chain.
#pragma once

#include "levelray/mesh/edge_table.hpp"

namespace levelray {

struct Duplicates {
  std::uint64_t same = 0;             // triangles with an earlier one of the same vertices and orientation
  std::uint64_t opposite = 0;         // vertex triples that have triangles of both orientations
  std::vector<std::uint32_t> dropped; // ascending
  std::uint64_t dropped_same = 0;     // because they are repeated
  std::uint64_t dropped_opposite = 0; // because their shell is double-sided
  std::uint64_t kept_same = 0, kept_opposite = 0; // repeated triangles and pairs that stay
};

// A repeated triangle is dropped, unless the mesh is closed because of it. That is decided for each cluster
// of repeated triangles that share edges, by its edges that triangles outside the cluster meet too:
// repetitions stay when the oriented chain has no boundary there with them and one without them, or when
// dropping would leave more edges with an odd number of triangles (two tetrahedra on a doubled face;
// whichever way it is oriented).
//
// Opposite pairs stay: they cancel in the winding number. But where at least 90 % of a shell (connected over
// edges) is in pairs it encloses nothing that way; then, when `single_double_sided`, the later half of each
// group of triangles over the same vertices is dropped, if that is how at least 90 % of the whole mesh are,
// or if the other half of the shell is closed (has an even number of triangles at each edge).
Duplicates find_duplicates(const std::vector<Triangle>& triangles, const EdgeTable& edges,
                           bool single_double_sided);

} // namespace levelray
