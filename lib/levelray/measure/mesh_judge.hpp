// What a sample of a conversion must be, by sums over all triangles in long double: slow, and nothing in
// common with mesh/ and convert/ but the mesh.
#pragma once

#include "levelray/field/field.hpp"
#include "levelray/mesh/triangle_mesh.hpp"

namespace levelray {

// The distance from p to the nearest point of the mesh, infinite for none. Of each triangle the nearest of
// its edges' points, and the foot of the perpendicular where that lies in it; triangles without area are
// their edges.
Extended mesh_distance(const TriangleMesh& mesh, const Vec3d& p);

// The generalised winding number (Jacobson et al. 2013, section 3) by solid angles in the form of Van
// Oosterom and Strackee 1983, eq. 8.
Extended mesh_winding(const TriangleMesh& mesh, const Vec3d& p);

} // namespace levelray
