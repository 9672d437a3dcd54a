// The surface of a sampled field as triangles: the zero set of its trilinear interpolant.
#pragma once

#include "levelray/mesh/triangle_mesh.hpp"

#include <array>

namespace levelray {

// Triangles on the zero set of the trilinear interpolant of one cell.
//
// The cell is cut into `divisions`^3 cubes and each of those into the six tetrahedra around its main diagonal
// (Freudenthal 1942, Kuhn 1960), in which the zero set of a linear function is a triangle or a quadrilateral
// (marching tetrahedra: Doi and Koide 1991). Ours differs in that vertices are put where the interpolant
// itself is zero along the tetrahedron's edge, not its linear approximation. Diagonals fit across faces and
// the interpolant is the same on both sides of them, so the triangles of all cells form a surface without
// cracks; it has boundary only where the field's samples end.
//
// How far from the zero set? On a tetrahedron whose corners lie within R of its midpoint, R = sqrt(3) / (2
// n), linear interpolation errs by at most R^2 / 2 * M (M: the largest second derivative of the interpolant
// in the cell), and the zero set moves by that over the gradient's length: 3/(8 n^2) M / |grad|, 0.024 voxel
// for n = 4 where the surface's radius of curvature is a voxel.
//
// `corners`: values at the corners, bit 0 of the index: x, 1: y, 2: z; any finite numbers, negative inside (0
// is outside). `at`: the lowest corner; vertices are in the same units, in which the cell has size 1. Appends
// three vertices of its own for each triangle; triangles that are a segment or a point are possible.
void append_zero_set(const std::array<float, 8>& corners, const Vec3d& at, int divisions, TriangleMesh& mesh);

// The largest `divisions`.
inline constexpr int max_zero_set_divisions = 8;

} // namespace levelray
