// Normals that stay those of the faces right up to an edge: near a crease, the normal of the flat piece of
// the field on which the hit lies, found among the cells around; elsewhere half-voxel offset differences.
//
// Ours. The idea is that of dual contouring (Ju et al. 2002, section 2.1: a feature is where planes that are
// known on either side meet), turned from placing vertices to choosing normals, and of one-sided stencils
// that do not look across a discontinuity (ENO: Harten et al. 1987). Every scheme that blends samples from
// both sides of a 90 degree edge is off by 45 degrees on it, at any resolution.
//
//  1. Crease or not? At an edge between faces whose normals differ by the vector j, the second differences of
//     samples in a row add up to a component of j; one of them is at least |j| / (2 sqrt 3). On a smooth
//     surface they are at most 1/R, with R the radius of curvature in voxels. If none of those of the 12
//     rows through the cell exceeds 1/5 of the largest first difference, the field is smooth here (R above
//     9 voxels is, so on smooth shapes this is a scheme of second order; faces must meet at an angle of 140
//     degrees or less to be surely told apart), and so are the 32 samples that offset differences read.
//  2. Else look for flat pieces: among the 27 cells of the 64 samples those whose interpolant is linear, by
//     the twists of its six faces, within 1/100 of the largest second difference. Such a cell lies on one
//     side of the crease, and its gradient is that of one face. At least 12 of the 64 samples must lie on its
//     plane within that tolerance: narrow rounds (a torus whose tube has a radius of 1.5 or 3 voxels) have
//     hardly such cells, and none that many samples agree with.
//  3. A crease has two sides: there must be another such plane, turned by 26 degrees or more; or, where the
//     other side is too far off to show, the plane must have 28 of the samples. Coarse liquids, whose curved
//     surface is made of flat facets by redistancing, have neither, but for their rims: without this rule it
//     moved a fifth of their normals by more than 2 degrees, with it one in 200 at the most.
//  4. The hit lies on the plane that is nearest to it, which must be within 0.6 voxel: the interpolated
//     surface cuts an edge by up to half a voxel. Without any plane the answer is that of offset differences.
//
// All of it is independent of the field's scale, and of distances: a plane is a plane. What lies beyond the
// band is worth +-background; cells there have no gradient and count for nothing. Not continuous, on purpose.
// Creases between curved faces (R below some 100 voxels) are rounded as in other schemes.
#pragma once

#include "levelray/normal/cell_position.hpp"
#include "levelray/normal/neighbourhood.hpp"

#include <string_view>

namespace levelray {

struct SharpFeatures {
  static constexpr std::string_view name = "sharp-features";
  static constexpr bool smooth = true;
  static constexpr std::string_view source =
      "ours: offset differences, at creases the plane of one side; after Ju et al. 2002, section 2.1";
  static constexpr int samples = 64, interpolations = 6;
  static constexpr bool whole = true;

  static Vec3d gradient(const Neighbourhood& f, const CellPosition& at);
};

} // namespace levelray
