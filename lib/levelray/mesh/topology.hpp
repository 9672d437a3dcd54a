// Counting what a mesh is made of.
#pragma once

#include "levelray/mesh/edge_table.hpp"
#include "levelray/mesh/prepare.hpp"

namespace levelray {

// Fills in components, shells, boundary edges and loops, non-manifold edges and vertices, winding clashes and
// `closed`, for a welded mesh. A vertex is non-manifold when its triangles fall into more than one fan,
// connected over edges at the vertex. Boundary loops that touch in a vertex count as one.
void count_topology(const TriangleMesh& mesh, const EdgeTable& edges, MeshReport& report);

// Whether the triangle's area is more than the rounding of its corners and of computing it; where it is not,
// its normal means nothing.
bool has_area(const Vec3d& a, const Vec3d& b, const Vec3d& c);

// Triangles without an area.
std::uint64_t count_without_area(const TriangleMesh& mesh);

// The largest diagonal of the boxes around connected parts of a set of edges; 0 without edges.
double largest_part(const TriangleMesh& mesh, const std::vector<std::array<std::uint32_t, 2>>& segments);

} // namespace levelray
