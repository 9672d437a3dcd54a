#include "levelray/render/surface_extent.hpp"

#include "levelray/core/parallel.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace levelray {

namespace {

// The largest dot product of a direction with a point of the cube that spans `size` voxels from `corner`.
double cube_support(const Vec3d& corner, double size, const Vec3d& d) {
  return corner.dot(d) + size * (std::max(d.x, 0.0) + std::max(d.y, 0.0) + std::max(d.z, 0.0));
}

// Whether the cube may hold a point farther out than those found.
bool may_reach_beyond(const Vec3d& corner, double size, std::span<const Vec3d> directions,
                      const std::vector<double>& support) {
  for (std::size_t d = 0; d < directions.size(); ++d)
    if (cube_support(corner, size, directions[d]) > support[d]) return true;
  return false;
}

// Raises `support` (voxel units) by the crossings on the 12 edges of the cell at (i,j,k).
void add_cell(const BlockGrid& grid, const Vec3i& at, std::span<const Vec3d> directions,
              std::vector<double>& support) {
  double value[8];
  for (int c = 0; c < 8; ++c) value[c] = grid.value(at.x + (c & 1), at.y + (c >> 1 & 1), at.z + (c >> 2));
  for (int c = 0; c < 8; ++c)
    for (int axis = 0; axis < 3; ++axis) {
      const int other = c | 1 << axis;
      if (other == c || (value[c] <= 0) == (value[other] <= 0)) continue;
      Vec3d p(at.x + (c & 1), at.y + (c >> 1 & 1), at.z + (c >> 2));
      p[axis] += value[c] / (value[c] - value[other]); // signs differ: the quotient is in [0,1]
      for (std::size_t d = 0; d < directions.size(); ++d)
        support[d] = std::max(support[d], p.dot(directions[d]));
    }
}

} // namespace

std::vector<double> surface_support(const BlockGrid& grid, std::span<const Vec3d> directions) {
  // Maxima of chunks of nodes, joined; they do not depend on the order. Few cells are looked at: the others
  // cannot reach beyond what their chunk has found.
  constexpr std::size_t grain = 64;
  const std::vector<double> none(directions.size(), -std::numeric_limits<double>::infinity());
  std::vector<std::vector<double>> parts((grid.nodes.size() + grain - 1) / grain, none);
  parallel_for(grid.nodes.size(), grain, [&](std::size_t begin, std::size_t end) {
    std::vector<double>& part = parts[begin / grain];
    for (std::size_t n = begin; n < end; ++n) {
      const BlockGrid::Node& node = grid.nodes[n];
      std::size_t block = node.first_block;
      for (std::uint64_t left = node.stored; left != 0; left &= left - 1, ++block) {
        const int bit = std::countr_zero(left);
        const Vec3i corner = node.coord * node_dim + Vec3i(bit_x(bit), bit_y(bit), bit_z(bit)) * block_dim;
        if (grid.cells[block] == 0 || !may_reach_beyond(Vec3d(corner), block_dim, directions, part)) continue;
        for (std::uint64_t cells = grid.cells[block]; cells != 0; cells &= cells - 1) {
          const int cell = std::countr_zero(cells);
          const Vec3i at = corner + Vec3i(bit_x(cell), bit_y(cell), bit_z(cell));
          if (may_reach_beyond(Vec3d(at), 1, directions, part)) add_cell(grid, at, directions, part);
        }
      }
    }
  });

  std::vector<double> support = none;
  for (std::size_t d = 0; d < directions.size(); ++d) {
    for (const auto& part : parts) support[d] = std::max(support[d], part[d]);
    if (std::isfinite(support[d]))
      support[d] = grid.transform.origin.dot(directions[d]) + support[d] * grid.transform.voxel_size;
  }
  return support;
}

Box3d surface_bounds(const BlockGrid& grid) {
  constexpr std::array<double, 2> signs{1, -1};
  std::vector<Vec3d> directions;
  for (const double sign : signs)
    for (int axis = 0; axis < 3; ++axis) directions.emplace_back(0, 0, 0)[axis] = sign;
  const std::vector<double> s = surface_support(grid, directions);
  return std::isfinite(s[0]) ? Box3d(Vec3d(-s[3], -s[4], -s[5]), Vec3d(s[0], s[1], s[2])) : Box3d();
}

} // namespace levelray
