// From a soup to a mesh fit for signing: welds, drops what has no area, finds shells, makes orientation
// consistent, and reports.
#pragma once

#include "levelray/mesh/triangle_mesh.hpp"

namespace levelray {

// How the triangles of the input were oriented, as found (not as repaired).
enum class Orientation { outward, inverted, mixed, non_orientable, undefined };
const char* orientation_name(Orientation orientation);

// Facts about the input, for the user. Vertices are merged by exact position before edges are counted.
struct MeshReport {
  std::uint64_t vertices = 0;  // as read
  std::uint64_t triangles = 0; // as read, after fan or ear triangulation
  std::uint64_t unreferenced_vertices = 0;
  std::uint64_t merged_vertices = 0; // duplicates by exact position
  std::uint64_t degenerate_triangles =
      0; // a repeated position, or zero area: kept for distance when they have extent, no part of the sign
  std::uint64_t duplicate_triangles = 0; // same three positions and orientation as another; dropped
  std::uint64_t opposite_triangles = 0;  // pairs of opposite orientation
  std::uint64_t components = 0;          // connected over shared vertices ("shells" over edges below)
  std::uint64_t shells = 0;              // connected over shared edges
  std::uint64_t boundary_edges = 0;      // edges with one triangle
  std::uint64_t boundary_loops = 0;
  std::uint64_t non_manifold_edges = 0; // edges with more than two triangles
  std::uint64_t non_manifold_vertices = 0;
  std::uint64_t winding_clashes = 0;   // manifold edges whose two triangles run along them the same way
  std::uint64_t flipped_triangles = 0; // turned by the repair
  bool closed = false;                 // every edge has at least two triangles
  Orientation orientation = Orientation::undefined;
  Box3d bounds;
  double volume = 0; // signed, of the repaired mesh; open shells are capped towards their boundary's centroid
  double longest_hole = 0; // world units: largest diagonal of a boundary loop's box
};

struct PreparedMesh {
  TriangleMesh mesh; // welded; triangles oriented consistently and outward as far as possible
  MeshReport report;
  // The oriented boundary of `mesh` as a chain: for each undirected edge whose triangles run along it
  // unequally often in the two directions, the edge repeated as often as the difference, in the direction
  // that cancels it. Empty iff the winding number is an integer everywhere off the surface.
  std::vector<std::array<std::uint32_t, 2>> open_edges;
  std::vector<std::string> warnings; // one line each, for the user
};

struct PrepareOptions {
  bool trust_orientation = false; // leave every triangle as it is
};

// Throws Error(bad_input) for meshes without triangles or without extent.
PreparedMesh prepare_mesh(const TriangleMesh& mesh, const PrepareOptions& options = {});

} // namespace levelray
