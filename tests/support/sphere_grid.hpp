// Block grids of made-up fields, by brute force: no code in common with the converter.
#pragma once

#include "levelray/grid/block_grid.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace levelray::test {

// Samples `field` (any callable double(Vec3d), world units, negative inside) at every sample origin +
// voxel_size * (i,j,k) in `box` (world space); samples beyond the box are outside. Values are
// rounded to float and clamped to +-background, background = half_width_voxels * voxel_size rounded up; a
// sample is active iff |value| < background. A block is stored iff it has an active sample, or a cell whose
// corners are not all strictly of one sign (what tracing relies on).
template <class Field>
BlockGrid sample_grid(const Field& field, double voxel_size, double half_width_voxels, const Box3d& box,
                      const Vec3d& origin = Vec3d(0, 0, 0)) {
  BlockGrid grid;
  grid.transform.origin = origin;
  grid.transform.voxel_size = voxel_size;
  grid.background = static_cast<float>(half_width_voxels * voxel_size);
  if (grid.half_width_voxels() < half_width_voxels) // never less, as OpenVDB's check of level sets wants it
    grid.background = std::nextafter(grid.background, std::numeric_limits<float>::infinity());

  // Cover the samples of the box and one more on each side by nodes.
  Vec3i low, high; // first and last sample in the box
  for (int a = 0; a < 3; ++a) {
    low[a] = static_cast<int>(std::ceil((box.min[a] - origin[a]) / voxel_size));
    high[a] = static_cast<int>(std::floor((box.max[a] - origin[a]) / voxel_size));
    grid.node_min[a] = (low[a] - 1) >> 4;
    grid.node_dims[a] = ((high[a] + 1) >> 4) - grid.node_min[a] + 1;
  }
  const Vec3i dims = grid.node_dims * node_dim, first = grid.node_min * node_dim;
  const auto at = [&](int i, int j, int k) { // dense index of a sample
    return static_cast<std::size_t>(i - first.x) +
           static_cast<std::size_t>(dims.x) *
               (static_cast<std::size_t>(j - first.y) + static_cast<std::size_t>(dims.y) * (k - first.z));
  };
  std::vector<float> dense(static_cast<std::size_t>(dims.x) * dims.y * dims.z, grid.background);
  for (int k = low.z; k <= high.z; ++k)
    for (int j = low.y; j <= high.y; ++j)
      for (int i = low.x; i <= high.x; ++i) {
        const float d = static_cast<float>(field(grid.transform.to_world(Vec3d(i, j, k))));
        dense[at(i, j, k)] = std::clamp(d, -grid.background, grid.background) + 0.0f; // -0 becomes +0
      }
  const auto value = [&](int i, int j, int k) { // beyond the nodes everything is outside
    return i >= first.x + dims.x || j >= first.y + dims.y || k >= first.z + dims.z ? grid.background
                                                                                   : dense[at(i, j, k)];
  };

  // Store the blocks that need it, and count the others as inside or outside.
  for (int z = 0; z < grid.node_dims.z; ++z)
    for (int y = 0; y < grid.node_dims.y; ++y)
      for (int x = 0; x < grid.node_dims.x; ++x) {
        BlockGrid::Node node;
        node.coord = grid.node_min + Vec3i(x, y, z);
        node.first_block = grid.active.size();
        for (int bit = 0; bit < 64; ++bit) {
          const Vec3i corner = node.coord * node_dim + Vec3i(bit_x(bit), bit_y(bit), bit_z(bit)) * block_dim;
          bool negative = false, positive = false; // of the corners of the block's cells; 0 counts for both
          for (int c = 0; c < 125; ++c) {
            const float d = value(corner.x + c % 5, corner.y + c / 5 % 5, corner.z + c / 25);
            negative |= d <= 0;
            positive |= d >= 0;
          }
          std::uint64_t active = 0;
          float samples[samples_per_block];
          for (int s = 0; s < samples_per_block; ++s) {
            samples[s] = value(corner.x + bit_x(s), corner.y + bit_y(s), corner.z + bit_z(s));
            active |= std::uint64_t{std::fabs(samples[s]) < grid.background} << s;
          }
          if (active || (negative && positive)) {
            node.stored |= std::uint64_t{1} << bit;
            grid.values.insert(grid.values.end(), samples, samples + samples_per_block);
            grid.active.push_back(active);
          } else if (negative) {
            node.inside |= std::uint64_t{1} << bit;
          }
        }
        if (node.stored || (node.inside && node.inside != ~std::uint64_t{0})) {
          grid.node_table.push_back(static_cast<std::uint32_t>(grid.nodes.size()));
          grid.nodes.push_back(node);
        } else {
          grid.node_table.push_back(node.inside ? BlockGrid::inside_node : BlockGrid::outside_node);
        }
      }
  update_cell_masks(grid);
  return grid;
}

// The exact distance to a sphere.
inline auto sphere_field(const Vec3d& centre, double radius) {
  return [=](const Vec3d& p) { return (p - centre).length() - radius; };
}

// A ball of `radius_voxels` in a box of three different extents around it, off the sample lattice, at
// negative and positive indices; unit voxels unless told.
inline BlockGrid sphere_grid(double radius_voxels, double half_width_voxels = 3, double voxel_size = 1) {
  const Vec3d centre = Vec3d(-2.3, 1.7, 0.4) * voxel_size;
  const double r = (radius_voxels + half_width_voxels + 2) * voxel_size;
  return sample_grid(
      sphere_field(centre, radius_voxels * voxel_size), voxel_size, half_width_voxels,
      Box3d(centre - Vec3d(r, r + 17 * voxel_size, r + 35 * voxel_size), centre + Vec3d(r, r, r)));
}

} // namespace levelray::test
