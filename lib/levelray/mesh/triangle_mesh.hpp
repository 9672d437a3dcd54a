// An indexed triangle soup, and what its reader had to say about it.
#pragma once

#include "levelray/core/vec.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace levelray {

using Triangle = std::array<std::uint32_t, 3>; // vertex indices, counter-clockwise seen from outside

// Positions in world units, finite, in double precision. Triangles may share vertices, repeat, intersect or
// be degenerate: the soup is what the file says. Every index is below vertices.size().
struct TriangleMesh {
  std::vector<Vec3d> vertices;
  std::vector<Triangle> triangles;

  Box3d bounds() const { // of the vertices that triangles use; empty without triangles
    Box3d box;
    for (const Triangle& t : triangles)
      for (const std::uint32_t v : t) box.extendBy(vertices[v]);
    return box;
  }
};

// A mesh as read from a file: the soup and one-line remarks for the user (skipped faces, ignored elements,
// non-planar polygons).
struct MeshFile {
  TriangleMesh mesh;
  std::string format; // "obj", "ply", "stl" or "off"
  std::vector<std::string> warnings;
};

} // namespace levelray
