// Which triangles meet in which edges: the facts that topology is told from.
//
// Not a half-edge structure: OpenMesh's, like any other whose edges have two sides, cannot hold edges with
// three faces or faces of clashing orientation, and those are what we have to report. OpenMesh is the second
// opinion in tests, on manifold meshes.
//
// Half-edge 3t+k runs from corner k of triangle t to its next corner.
#pragma once

#include "levelray/mesh/triangle_mesh.hpp"

#include <limits>
#include <span>

namespace levelray {

constexpr std::uint32_t no_index = std::numeric_limits<std::uint32_t>::max();

struct EdgeTable {
  std::vector<std::uint32_t> half_edges; // all of them, grouped by undirected edge, ascending in each group
  std::vector<std::uint32_t> first;      // edge e's group is half_edges[first[e] .. first[e+1])

  std::size_t size() const { return first.empty() ? 0 : first.size() - 1; }
  std::span<const std::uint32_t> of(std::size_t edge) const {
    return {half_edges.data() + first[edge], first[edge + 1] - first[edge]};
  }
};

inline std::uint32_t edge_start(const std::vector<Triangle>& triangles, std::uint32_t h) {
  return triangles[h / 3][h % 3];
}
inline std::uint32_t edge_end(const std::vector<Triangle>& triangles, std::uint32_t h) {
  return triangles[h / 3][(h + 1 - h / 3 * 3) % 3];
}
inline std::uint32_t opposite_vertex(const std::vector<Triangle>& triangles, std::uint32_t h) {
  return triangles[h / 3][(h + 2 - h / 3 * 3) % 3];
}
// Whether the half-edge runs from its lower to its higher vertex; two of one edge clash when both do or
// neither.
inline bool runs_up(const std::vector<Triangle>& triangles, std::uint32_t h) {
  return edge_start(triangles, h) < edge_end(triangles, h);
}

// Edges come ordered by their lower, then by their higher vertex. Triangles must have three different
// vertices below `vertex_count`. Throws Error(limit) for 2^32/3 triangles and more.
EdgeTable build_edge_table(const std::vector<Triangle>& triangles, std::size_t vertex_count);

// For each half-edge the only other one of its edge, or no_index where the edge has one triangle or more than
// two.
std::vector<std::uint32_t> find_twins(const EdgeTable& edges);

// The edges whose half-edges run up and down unequally often, ascending, with the difference (up minus down):
// the oriented boundary of the triangles as a chain.
struct OpenEdge {
  std::uint32_t edge;
  int excess;
};
std::vector<OpenEdge> find_boundary_chain(const std::vector<Triangle>& triangles, const EdgeTable& edges);

// For each half-edge its edge.
std::vector<std::uint32_t> find_edges(const EdgeTable& edges);

} // namespace levelray
