// Normals that tell inside from outside at any nearest point of a closed mesh.
#pragma once

#include "levelray/mesh/closest_point.hpp"

namespace levelray {

// Baerentzen & Aanaes 2005, "Signed distance computation using the angle weighted pseudonormal", section 3:
// on a closed, consistently oriented surface that does not cut itself, (p - q).n has the sign of p's side,
// where q is the point nearest to p and n the pseudonormal of the feature that holds q: the face's normal,
// the sum of the two faces' normals at an edge, and their sum weighted by the angles at a vertex. At edges
// with more than two triangles ours sums over all, for which there is no such theorem.
//
// Triangles without area have no normal, but hold T-junctions closed: they lie flat on the neighbour along
// their longest edge. Ours gives them that neighbour's normal towards their two shorter edges and their
// middle vertex, and towards the longest edge the sum of the normals from the shorter ones.
class Pseudonormals {
 public:
  // The mesh must be welded and have no triangle with a repeated vertex (prepare_mesh's result). Copies what
  // it needs.
  explicit Pseudonormals(const TriangleMesh& mesh);

  // The pseudonormal of a feature of a triangle, numbered as in closest_point.hpp; a direction without a
  // meaningful length, and zero where nothing around has an area.
  const Vec3d& at(std::uint32_t triangle, int feature) const;

 private:
  std::vector<Vec3d> faces_, edges_, vertices_;
  std::vector<std::uint32_t> edge_of_; // per half-edge
  std::vector<Triangle> triangles_;
};

} // namespace levelray
