// The generalised winding number of a triangle soup (Jacobson, Kavan & Sorkine-Hornung 2013, section 3), by
// direct summation.
//
// The reference that signs are checked against: a sum over all triangles in double precision, no tree, no
// approximation.
#pragma once

#include "levelray/mesh/triangle_mesh.hpp"

namespace levelray {

// The signed solid angle of triangle (a,b,c) seen from p, in steradians, in [-2 pi, 2 pi]; positive when p
// lies behind the triangle (its counter-clockwise side faces away). Van Oosterom & Strackee 1983, eq. 8. 0
// for p in the triangle's plane; on the triangle that is the mean of both sides, so that the winding number
// of a closed surface is 1/2 on its faces. The error is a few ulp of 2 pi for p further from the triangle's
// plane than its own coordinates' rounding.
double solid_angle(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& p);

// Sum of the solid angles over 4 pi: 1 inside a closed outward surface, 0 outside.
double winding_number(const TriangleMesh& mesh, const Vec3d& p);

} // namespace levelray
