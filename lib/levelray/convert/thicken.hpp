// From the distances to a surface to those of a sheet along it.
#pragma once

#include "levelray/convert/sign.hpp"

#include <vector>

namespace levelray {

// The sheet that --thicken makes: all points within R of the surface, whatever the surface's topology and
// orientation. Its field is |d| - R, which is the signed distance to the sheet's boundary except near the
// surface itself, where the nearest point of the boundary may lie on either side of a curved sheet.
//
// Replaces the band's unsigned distances d (voxels) by |d - R| and returns the sides, one entry per table
// entry: inside where d < R. The band must be exact up to R plus the half-width that is to be stored. A
// difference is rounded to float once.
std::vector<NodeSides> thicken_band(Band& band, double radius_voxels);

// Sheets at least this thick have no holes where they are flat, however they lie to the lattice. Proof: let
// the sheet be the points within R of a plane, and A, B the sides beyond it. The projections of a cell's
// corners on the plane's normal n span |n|_1 <= sqrt(3), so with 2R >= sqrt(3) no cell has corners in both A
// and B. A way through the interpolated sheet, on which values are positive, would leave a cell with corners
// in A and enter one with corners in B through a face whose corners lie in neither: values there are <= 0.
inline constexpr double safe_thickness_voxels = 1.7320508075688773;
// Below one voxel a flat sheet between two layers of samples is lost altogether.
inline constexpr double least_thickness_voxels = 1;

} // namespace levelray
