// The named shapes of field/reference_shapes.hpp behind one door, so that suites are compiled once.
#pragma once

#include "levelray/field/field.hpp"
#include "levelray/grid/block_grid.hpp"

#include <functional>
#include <string>
#include <vector>

namespace levelray {

struct Reference {
  std::string name, source;
  bool is_distance = true, smooth = true; // see field/field.hpp
  Box3d bounds;
  std::function<double(const Vec3d&)> value;
  std::function<Vec3d(const Vec3d&)> gradient;
  std::function<Chord(const WorldRay&)> chord;
  std::function<double(const Vec3d&, double)> curvature;
  std::function<BlockGrid(double voxel_size, double half_width_voxels)>
      grid; // samples at multiples of the voxel
};

// All of the list, in its order.
std::vector<Reference> all_references();

// A bound of |interpolant - value| at a point, for samples `voxel_size` apart, of a band `half_width` wide,
// both in world units.
//
// Where the field has second derivatives all over the cell's reach, sqrt(3) voxels, interpolation along one
// axis is off by h^2/8 sup|f_aa|, and the three follow each other with weights that add up to 1: h^2/8 times
// the field's `curvature`. Where not, the interpolant is a mean of corner values, each off by the distance to
// its corner at most: by Cauchy and Schwarz h sqrt(sum x(1-x)) <= sqrt(3)/2 h. Samples are rounded to float,
// by 2^-24 of the half width at most, which weights that add up to 1 do not enlarge.
double interpolation_error(const Reference& shape, const Vec3d& p, double voxel_size, double half_width);

// A shape and the grid it was sampled into.
struct SampledReference {
  const Reference* shape;
  double voxel_size, half_width; // world units

  double error(const Vec3d& p) const { return interpolation_error(*shape, p, voxel_size, half_width); }
};

} // namespace levelray
