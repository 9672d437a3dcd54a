// From a soup to a mesh fit for signing: welds, drops what is repeated or has less than three corners, makes
// orientation consistent, turns shells outward, and reports.
#pragma once

#include "levelray/mesh/triangle_mesh.hpp"

namespace levelray {

// How the triangles of the input were oriented, as found (not as repaired).
enum class Orientation { outward, inverted, mixed, non_orientable, undefined };
const char* orientation_name(Orientation orientation);

// Facts about the input, for the user, where nothing else is said. Vertices are merged by exact position (-0
// is +0) and triangles with a repeated position left out before edges are counted; repeated triangles count.
struct MeshReport {
  std::uint64_t vertices = 0;  // as read
  std::uint64_t triangles = 0; // as read, after fan or ear triangulation
  std::uint64_t unreferenced_vertices = 0;
  std::uint64_t merged_vertices = 0; // duplicates by exact position
  // With a repeated position (dropped), or no area beyond rounding (kept: they hold edges together and have a
  // distance).
  std::uint64_t degenerate_triangles = 0;
  // Same three positions and orientation as an earlier one; dropped, unless the mesh is closed because of
  // them (duplicates.hpp).
  std::uint64_t duplicate_triangles = 0;
  // Three positions with triangles of both orientations; kept, unless the mesh is double-sided
  // (duplicates.hpp).
  std::uint64_t opposite_triangles = 0;
  std::uint64_t components = 0;         // connected over shared vertices ("shells" over edges below)
  std::uint64_t shells = 0;             // connected over shared edges
  std::uint64_t boundary_edges = 0;     // edges with one triangle
  std::uint64_t boundary_loops = 0;     // connected sets of them: holes that touch in a vertex count as one
  std::uint64_t non_manifold_edges = 0; // edges with more than two triangles
  std::uint64_t non_manifold_vertices = 0; // whose triangles are more than one fan, connected over edges
  std::uint64_t winding_clashes = 0;       // edges with two triangles, which run along it the same way
  std::uint64_t flipped_triangles = 0;     // turned by the repair
  bool closed = false;                     // every edge has at least two triangles
  Orientation orientation = Orientation::undefined;
  Box3d bounds;      // of the prepared mesh
  double volume = 0; // signed, of the prepared mesh; open shells are capped towards their boundary's centroid
  double longest_hole = 0; // world units: largest diagonal of a connected part of open_edges' box, see below
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
  // The mesh is meant as a sheet without inside and outside: no warnings of holes and orientation, which do
  // not matter then.
  bool sheet = false;
};

// Throws Error(bad_input) for meshes without triangles, without extent, or without area; Error(limit)
// for 1.4e9 triangles and more, and for sizes that are not from 1e-50 to 1e50. The result does not depend on
// the number of threads.
PreparedMesh prepare_mesh(const TriangleMesh& mesh, const PrepareOptions& options = {});

} // namespace levelray
