// Merging vertices by exact position.
#pragma once

#include "levelray/mesh/triangle_mesh.hpp"

namespace levelray {

struct WeldedMesh {
  TriangleMesh mesh; // distinct positions (-0 is +0) that triangles use, in order of first appearance
  std::uint64_t unreferenced_vertices = 0;
  std::uint64_t merged_vertices = 0;     // vertices at the position of an earlier one
  std::uint64_t collapsed_triangles = 0; // dropped: two corners at the same position
};

// Vertices and triangles keep their order. Positions are compared exactly: a tolerance would close cracks
// that the user should hear about, and could turn thin parts inside out.
WeldedMesh weld(const TriangleMesh& mesh);

} // namespace levelray
