// Converting in tests, and judging the result by a path that shares no code with it.
#pragma once

#include "levelray/convert/mesh_to_grid.hpp"
#include "levelray/mesh/triangle_bvh.hpp"
#include "levelray/mesh/winding_number.hpp"

#include <cmath>

namespace levelray::test {

inline ConvertedGrid convert(const TriangleMesh& mesh, double voxel_size,
                             SignMethod sign = SignMethod::automatic, double half_width_voxels = 3) {
  ConvertOptions options;
  options.voxel_size = voxel_size;
  options.sign = sign;
  options.half_width_voxels = half_width_voxels;
  return mesh_to_grid(prepare_mesh(mesh), options);
}

// Calls visit(i, j, k, value, is_active) for every sample of every stored block.
template <class Visit>
void for_each_sample(const BlockGrid& grid, Visit&& visit) {
  for (const BlockGrid::Node& node : grid.nodes)
    for (int bit = 0; bit < 64; ++bit) {
      if (!(node.stored >> bit & 1)) continue;
      const std::size_t block = BlockGrid::block_index(node, bit);
      const Vec3i corner = node.coord * node_dim + Vec3i(bit_x(bit), bit_y(bit), bit_z(bit)) * block_dim;
      for (int s = 0; s < samples_per_block; ++s)
        visit(corner.x + bit_x(s), corner.y + bit_y(s), corner.z + bit_z(s),
              grid.values[block * samples_per_block + static_cast<std::size_t>(s)],
              static_cast<bool>(grid.active[block] >> s & 1));
    }
}

// The bound that convert/README.md derives, in world units: 1e-5 voxel for the geometry, and the rounding of
// the stored float.
inline double distance_bound(const BlockGrid& grid, double distance) {
  return 1e-5 * grid.transform.voxel_size + std::ldexp(std::abs(distance), -24);
}

// What is wrong with a grid, by every sample of its band: distances against the nearest triangle in double,
// signs against `inside(world position)`. Samples nearer to the surface than the bound have no sign to speak
// of.
struct BandErrors {
  std::uint64_t samples = 0, missing = 0, wrong_signs = 0;
  double worst_voxels = 0; // of active samples: | |value| - distance |
  bool beyond_bound = false;
};

template <class Inside>
BandErrors band_errors(const BlockGrid& grid, const TriangleMesh& mesh, Inside&& inside) {
  const TriangleBvh bvh(mesh);
  BandErrors errors;
  for_each_sample(grid, [&](int i, int j, int k, float value, bool is_active) {
    const Vec3d p = grid.transform.to_world(Vec3d(i, j, k));
    const auto nearest = bvh.closest_point(p, grid.background * 1.01);
    const double distance = nearest ? std::sqrt(nearest->distance_squared) : 2.0 * grid.background;
    const double bound = distance_bound(grid, distance);
    if (!is_active) {
      errors.missing += distance < grid.background - bound;
      if (std::abs(value) != grid.background) errors.beyond_bound = true;
    } else {
      ++errors.samples;
      const double error = std::abs(std::abs(double{value}) - distance);
      errors.worst_voxels = std::max(errors.worst_voxels, error / grid.transform.voxel_size);
      if (!(error <= bound)) errors.beyond_bound = true;
    }
    if (distance > bound && inside(p) != std::signbit(value)) ++errors.wrong_signs;
  });
  return errors;
}

// The winding number of a closed mesh by the signed crossings of one ray: exact, as TriangleBvh counts no
// edge twice.
inline int winding_by_ray(const TriangleBvh& bvh, const Vec3d& p, const Vec3d& direction) {
  int winding = 0;
  bvh.all_hits(WorldRay{p, direction}, [&](const TriangleHit& hit) { winding += hit.front ? -1 : 1; });
  return winding;
}

} // namespace levelray::test
