// Grids made for measuring: of any samples, and of any field.
#pragma once

#include "levelray/grid/block_grid.hpp"

#include <functional>
#include <string>
#include <vector>

namespace levelray {

struct NamedGrid {
  std::string name;
  BlockGrid grid;
};

// Samples low .. low + size - 1, all of them active, with whatever values; beyond them is the outside,
// +background. -0 becomes +0; NaN is not allowed.
BlockGrid grid_of_samples(const Vec3i& low, const Vec3i& size,
                          const std::function<float(int, int, int)>& value, float background,
                          const GridTransform& transform = {});

// A field's narrow band. `field` takes and gives voxels and is 1-Lipschitz; its inside lies within `extent`
// voxels of sample (0,0,0). Place and size as the transform says.
BlockGrid grid_of_field(const std::function<double(const Vec3d&)>& field, const Vec3d& extent,
                        const GridTransform& transform = {}, double half_width_voxels = 3);
inline BlockGrid grid_of_field(const std::function<double(const Vec3d&)>& field, double extent,
                               const GridTransform& transform = {}, double half_width_voxels = 3) {
  return grid_of_field(field, Vec3d(extent, extent, extent), transform, half_width_voxels);
}

// In voxels.
double ball_distance(const Vec3d& p, const Vec3d& centre, double radius);
// A box of those half sides about the origin, turned to the frame of that w axis, whichever u and v are.
double box_distance(const Vec3d& p, const Vec3d& half, const Vec3d& w = Vec3d(0, 0, 1));
double torus_distance(const Vec3d& p, double radius, double tube, const Vec3d& axis);
// Less than the distance: a sheet of the gyroid about `thickness` thick, cut off by a ball.
double gyroid_field(const Vec3d& p, double thickness, double ball);

// A ball of radius 6.3, a torus with a tube of radius 1, a plate 0.8 voxel thick, and a gyroid's sheet.
std::vector<NamedGrid> study_grids(const GridTransform& transform = {});

// The same samples at other places: sample (i,j,k) of the result is sample (i',j',k') of the grid with
// i'[order[a]] = sign[a] * i[a].
struct LatticeSymmetry {
  int order[3], sign[3];
  Vec3d moved(const Vec3d& v) const; // a place or a direction of the grid, in voxels, in the result
};
BlockGrid moved_grid(const BlockGrid& grid, const LatticeSymmetry& symmetry);

} // namespace levelray
