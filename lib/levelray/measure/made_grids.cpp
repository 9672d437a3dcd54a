#include "levelray/measure/made_grids.hpp"

#include "levelray/convert/field_to_grid.hpp"
#include "levelray/field/frame.hpp"
#include "levelray/grid/complete_blocks.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace levelray {

BlockGrid grid_of_samples(const Vec3i& low, const Vec3i& size,
                          const std::function<float(int, int, int)>& value, float background,
                          const GridTransform& transform) {
  BlockGrid grid;
  grid.transform = transform;
  grid.background = background;
  // One sample more below, as complete_blocks asks, and above.
  for (int a = 0; a < 3; ++a) {
    grid.node_min[a] = (low[a] - 1) >> 4;
    grid.node_dims[a] = ((low[a] + size[a]) >> 4) - grid.node_min[a] + 1;
  }
  for (int z = 0; z < grid.node_dims.z; ++z)
    for (int y = 0; y < grid.node_dims.y; ++y)
      for (int x = 0; x < grid.node_dims.x; ++x) {
        BlockGrid::Node node;
        node.coord = grid.node_min + Vec3i(x, y, z);
        node.first_block = grid.active.size();
        for (int bit = 0; bit < 64; ++bit) {
          const Vec3i corner = node.coord * node_dim + Vec3i(bit_x(bit), bit_y(bit), bit_z(bit)) * block_dim;
          std::uint64_t active = 0;
          float samples[samples_per_block];
          for (int s = 0; s < samples_per_block; ++s) {
            const Vec3i at = corner + Vec3i(bit_x(s), bit_y(s), bit_z(s));
            bool within = true;
            for (int a = 0; a < 3; ++a) within &= at[a] >= low[a] && at[a] < low[a] + size[a];
            samples[s] = within ? value(at.x, at.y, at.z) + 0.0f : background;
            active |= std::uint64_t{within} << s;
          }
          if (!active) continue;
          node.stored |= std::uint64_t{1} << bit;
          grid.values.insert(grid.values.end(), samples, samples + samples_per_block);
          grid.active.push_back(active);
        }
        grid.node_table.push_back(node.stored ? static_cast<std::uint32_t>(grid.nodes.size())
                                              : BlockGrid::outside_node);
        if (node.stored) grid.nodes.push_back(node);
      }
  complete_blocks(grid, std::numeric_limits<std::uint64_t>::max());
  return grid;
}

BlockGrid grid_of_field(const std::function<double(const Vec3d&)>& field, const Vec3d& extent,
                        const GridTransform& transform, double half_width_voxels) {
  struct Scaled {
    const std::function<double(const Vec3d&)>& field;
    const GridTransform& transform;
    double value(const Vec3d& p) const { return field(transform.to_voxel(p)) * transform.voxel_size; }
  };
  FieldSampling sampling;
  sampling.voxel_size = transform.voxel_size;
  sampling.origin = transform.origin;
  sampling.half_width_voxels = half_width_voxels;
  return field_to_grid(Scaled{field, transform}, sampling,
                       Box3d(transform.to_world(-extent), transform.to_world(extent)));
}

double ball_distance(const Vec3d& p, const Vec3d& centre, double radius) {
  return (p - centre).length() - radius;
}

double box_distance(const Vec3d& p, const Vec3d& half, const Vec3d& w) {
  const Vec3d q = w == Vec3d(0, 0, 1) ? p : Frame::along(Vec3d(0, 0, 0), w).to_local(p);
  const double x = std::fabs(q.x) - half.x, y = std::fabs(q.y) - half.y, z = std::fabs(q.z) - half.z;
  return Vec3d(std::max(x, 0.0), std::max(y, 0.0), std::max(z, 0.0)).length() +
         std::min(std::max({x, y, z}), 0.0);
}

double torus_distance(const Vec3d& p, double radius, double tube, const Vec3d& axis) {
  const double h = p.dot(axis), r = std::sqrt(std::max(0.0, p.dot(p) - h * h));
  return std::hypot(r - radius, h) - tube;
}

double gyroid_field(const Vec3d& p, double thickness, double ball) {
  const double scale = 0.35;
  const Vec3d q = p * scale;
  const double g =
      std::sin(q.x) * std::cos(q.y) + std::sin(q.y) * std::cos(q.z) + std::sin(q.z) * std::cos(q.x);
  // |grad g| <= sqrt(3) scale, since each of its components is a sum cos cos - sin sin' with Cauchy and
  // Schwarz.
  return std::max(std::fabs(g) / (scale * std::sqrt(3.0)) - thickness / 2, p.length() - ball);
}

std::vector<NamedGrid> study_grids(const GridTransform& transform) {
  const Vec3d off(-0.3, 0.7, 0.4), tilt = Vec3d(0.42, 0.31, 0.85).normalized();
  return {
      {"ball", grid_of_field([=](const Vec3d& p) { return ball_distance(p, off, 6.3); }, 8, transform)},
      {"torus",
       grid_of_field([=](const Vec3d& p) { return torus_distance(p - off, 9, 1, tilt); }, 11, transform)},
      {"plate", grid_of_field([=](const Vec3d& p) { return box_distance(p - off, Vec3d(9, 9, 0.4), tilt); },
                              15, transform)},
      {"gyroid",
       grid_of_field([=](const Vec3d& p) { return gyroid_field(p - off, 1.3, 10); }, 12, transform)}};
}

Vec3d LatticeSymmetry::moved(const Vec3d& v) const {
  return Vec3d(sign[0] * v[order[0]], sign[1] * v[order[1]], sign[2] * v[order[2]]);
}

BlockGrid moved_grid(const BlockGrid& grid, const LatticeSymmetry& symmetry) {
  const Vec3i first = grid.node_min * node_dim, last = first + grid.node_dims * node_dim - Vec3i(1, 1, 1);
  Box3i box;
  for (const Vec3i& corner : {first, last}) {
    const Vec3d p = symmetry.moved(Vec3d(corner));
    box.extendBy(Vec3i(static_cast<int>(p.x), static_cast<int>(p.y), static_cast<int>(p.z)));
  }
  return grid_of_samples(
      box.min, box.max - box.min + Vec3i(1, 1, 1),
      [&](int i, int j, int k) {
        const int at[3] = {i, j, k};
        int source[3];
        for (int a = 0; a < 3; ++a) source[symmetry.order[a]] = symmetry.sign[a] * at[a];
        return grid.value(source[0], source[1], source[2]);
      },
      grid.background, grid.transform);
}

} // namespace levelray
