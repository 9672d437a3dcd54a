#include "levelray/render/surface_extent.hpp"

#include "levelray/core/parallel.hpp"

#include <algorithm>
#include <limits>

namespace levelray {

namespace {

// Extends `extent` by the crossings on the 12 edges of the cell at (i,j,k), in voxel units.
void add_cell(const BlockGrid& grid, int i, int j, int k, const Vec3d& up, SurfaceExtent& extent) {
  double value[8];
  for (int c = 0; c < 8; ++c) value[c] = grid.value(i + (c & 1), j + (c >> 1 & 1), k + (c >> 2));
  for (int c = 0; c < 8; ++c)
    for (int axis = 0; axis < 3; ++axis) {
      const int other = c | 1 << axis;
      if (other == c || (value[c] <= 0) == (value[other] <= 0)) continue;
      Vec3d p(i + (c & 1), j + (c >> 1 & 1), k + (c >> 2));
      p[axis] += value[c] / (value[c] - value[other]); // signs differ: the quotient is in [0,1]
      extent.bounds.extendBy(p);
      extent.lowest = std::min(extent.lowest, p.dot(up));
    }
}

} // namespace

SurfaceExtent surface_extent(const BlockGrid& grid, const Vec3d& up) {
  // Extents of chunks of nodes, joined in order; minima do not depend on the order anyway.
  constexpr std::size_t grain = 64;
  SurfaceExtent empty;
  empty.lowest = std::numeric_limits<double>::infinity();
  std::vector<SurfaceExtent> parts((grid.nodes.size() + grain - 1) / grain, empty);
  parallel_for(grid.nodes.size(), grain, [&](std::size_t begin, std::size_t end) {
    SurfaceExtent& part = parts[begin / grain];
    for (std::size_t n = begin; n < end; ++n) {
      const BlockGrid::Node& node = grid.nodes[n];
      std::size_t block = node.first_block;
      for (std::uint64_t left = node.stored; left != 0; left &= left - 1, ++block) {
        const int at = std::countr_zero(left);
        for (std::uint64_t cells = grid.cells[block]; cells != 0; cells &= cells - 1) {
          const int cell = std::countr_zero(cells);
          add_cell(grid, node.coord.x * node_dim + bit_x(at) * block_dim + bit_x(cell),
                   node.coord.y * node_dim + bit_y(at) * block_dim + bit_y(cell),
                   node.coord.z * node_dim + bit_z(at) * block_dim + bit_z(cell), up, part);
        }
      }
    }
  });

  SurfaceExtent extent = empty;
  for (const SurfaceExtent& part : parts) {
    extent.bounds.extendBy(part.bounds);
    extent.lowest = std::min(extent.lowest, part.lowest);
  }
  if (extent.bounds.isEmpty()) return {};
  extent.bounds =
      Box3d(grid.transform.to_world(extent.bounds.min), grid.transform.to_world(extent.bounds.max));
  extent.lowest = grid.transform.origin.dot(up) + extent.lowest * grid.transform.voxel_size;
  return extent;
}

} // namespace levelray
