// A triangle as seven affine functions of position, local to a node of the grid.
#pragma once

#include "levelray/core/vec.hpp"

namespace levelray {

// With n the unit normal, e_i the unit edge directions and w_i = n x e_i their inward perpendiculars, for a
// point p relative to the node's centre:
//   plane(p)    = n . p + plane[3]         distance to the triangle's plane
//   inward_i(p) = w_i . p + inward[i][3]   distance inside edge i, in the plane
//   along_i(p)  = e_i . p + along[i][3]    position along edge i from its middle
//   d(p)^2 = plane^2 + (all inward_i >= threshold ? 0 : min_i(inward_i^2 + max(|along_i| - half[i], 0)^2))
// Voxel units. All values are formed in double and rounded once, so their errors stay below 2^-24 of the
// node's size whatever the triangle's distance from index 0.
struct TriangleFrame {
  float plane[4];
  float inward[3][4];
  float along[3][4];
  float half[3];
  float threshold; // 0; infinity where the triangle is a segment or a point
};

// `reach`: an upper bound for |p| + the distances of interest; long edges are clipped to it around the node,
// so that `along` stays small.
TriangleFrame make_triangle_frame(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& node_center,
                                  double reach);

} // namespace levelray
