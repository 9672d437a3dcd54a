// The point of a triangle nearest to a point: the reference that distances are tested with.
#pragma once

#include "levelray/mesh/triangle_mesh.hpp"

namespace levelray {

// The feature of a triangle that holds a point: its corners 0..2, its edges 3..5 (edge k from corner k to the
// next), or its inside.
enum Feature : int { feature_edge = 3, feature_face = 6 };

struct TrianglePoint {
  Vec3d point{0, 0, 0};
  double distance_squared = 0; // |p - point|^2 of the rounded point
  int feature = feature_face;
};

// The nearest point of triangle (a,b,c) to p; ties go to corners before edges before the inside, lower
// numbers first.
//
// Ericson 2004, section 5.1.5, decides between the Voronoi regions of corners, edges and face by the signs of
// products that cancel in slivers. Ours takes the nearest of four candidates, three edges (5.1.2) and the
// foot of the perpendicular where it falls inside, each of which is a point of the triangle to rounding: what
// a sliver's noisy normal can do is to lose the inside's candidate, and then an edge is off by at most half
// the sliver's height. Triangles without area are their edges, edges without length their corners.
//
// The distance's error is a few ulp of the largest coordinate difference to p.
TrianglePoint closest_point_on_triangle(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& p);

struct MeshPoint : TrianglePoint {
  std::uint32_t triangle = 0;
};

// The nearest over all triangles, by looking at each; ties go to the lowest triangle. The mesh must have
// triangles.
MeshPoint closest_point_brute_force(const TriangleMesh& mesh, const Vec3d& p);

} // namespace levelray
