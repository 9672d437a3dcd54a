#include "levelray/accel/surface_blocks.hpp"

#include "levelray/accel/box_masks.hpp"
#include "levelray/core/parallel.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <mutex>

namespace levelray {

namespace {

constexpr std::uint32_t no_node = 0xFFFFFFFFu;

std::uint64_t surface_mask(const BlockGrid& grid, const BlockGrid::Node& node) {
  std::uint64_t mask = 0;
  std::size_t block = node.first_block;
  for (std::uint64_t rest = node.stored; rest; rest &= rest - 1, ++block)
    if (grid.cells[block]) mask |= rest & (~rest + 1);
  return mask;
}

} // namespace

SurfaceBlocks::SurfaceBlocks(const BlockGrid& grid) {
  index_nodes(grid);
  if (nodes_.empty()) return;

  records_.resize(cells_.size() * record_floats);
  float largest_error = 0;
  std::mutex mutex;
  parallel_for(nodes_.size(), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) copy_samples(grid, n, grid.nodes[sources_[n]]);
    const std::size_t last = end < nodes_.size() ? nodes_[end].first : cells_.size();
    float largest = 0, least = std::numeric_limits<float>::infinity();
    for (std::size_t b = nodes_[begin].first; b < last; ++b) {
      largest = std::max(largest, record(b)[record_error]);
      least = std::min(least, record(b)[record_least]);
    }
    const std::lock_guard lock(mutex);
    largest_error = std::max(largest_error, largest);
    least_sample_ = std::min(least_sample_, least);
  });
  largest_sample_ = largest_error * 0x1p20f * (1 + 0x1p-22f); // the sum in copy_samples may be rounded down
  parallel_for(8, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t octant = begin; octant < end; ++octant) compute_leaps(static_cast<int>(octant));
  });
  sources_ = {};
}

void SurfaceBlocks::index_nodes(const BlockGrid& grid) {
  // Find the nodes with surface blocks, and the box of them.
  std::vector<std::uint64_t> masks(grid.nodes.size());
  parallel_for(masks.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) masks[n] = surface_mask(grid, grid.nodes[n]);
  });
  Box3i box;
  for (std::size_t n = 0; n < masks.size(); ++n)
    if (masks[n]) box.extendBy(grid.nodes[n].coord);
  if (box.isEmpty()) return;
  node_min_ = box.min;
  node_dims_ = box.max - box.min + Vec3i(1, 1, 1);

  // Number nodes in the order of the table, whatever the grid's order is, so that near ones lie near.
  const auto dims_x = static_cast<std::size_t>(node_dims_.x), dims_y = static_cast<std::size_t>(node_dims_.y);
  table_.assign(dims_x * dims_y * static_cast<std::size_t>(node_dims_.z), no_node);
  for (std::size_t n = 0; n < masks.size(); ++n) {
    if (!masks[n]) continue;
    const Vec3i at = grid.nodes[n].coord - node_min_;
    table_[static_cast<std::size_t>(at.x) +
           dims_x * (static_cast<std::size_t>(at.y) + dims_y * static_cast<std::size_t>(at.z))] =
        static_cast<std::uint32_t>(n);
  }
  std::uint64_t blocks = 0;
  for (std::uint32_t& entry : table_) {
    if (entry == no_node) continue;
    sources_.push_back(entry);
    nodes_.push_back({masks[entry], blocks});
    blocks += static_cast<std::uint64_t>(std::popcount(masks[entry]));
    entry = static_cast<std::uint32_t>(nodes_.size() - 1);
  }
  cells_.resize(blocks);

  // The box of their blocks.
  block_min_ = node_dims_ * 4;
  for (std::size_t n = 0; n < nodes_.size(); ++n) {
    const ChildExtent extent(nodes_[n].blocks);
    const Vec3i at = grid.nodes[sources_[n]].coord - node_min_;
    for (int a = 0; a < 3; ++a) {
      block_min_[a] = std::min(block_min_[a], 4 * at[a] + extent.low[a]);
      block_end_[a] = std::max(block_end_[a], 4 * at[a] + extent.high[a]);
    }
  }
}

void SurfaceBlocks::copy_samples(const BlockGrid& grid, std::size_t n, const BlockGrid::Node& source) {
  std::size_t out = nodes_[n].first;
  for (std::uint64_t rest = nodes_[n].blocks; rest; rest &= rest - 1, ++out) {
    const int bit = std::countr_zero(rest);
    const Vec3i corner = source.coord * node_dim + Vec3i(bit_x(bit), bit_y(bit), bit_z(bit)) * block_dim;
    cells_[out] = grid.cells[BlockGrid::block_index(source, bit)];

    // The block itself and the lowest layers of its seven neighbours towards +x, +y, +z.
    float* record = &records_[out * record_floats];
    for (int i = 0; i < 8; ++i) {
      const int dx = i & 1, dy = i >> 1 & 1, dz = i >> 2;
      bool inside = false;
      const float* values = grid.find_block(corner.x + 4 * dx, corner.y + 4 * dy, corner.z + 4 * dz, &inside);
      const float constant = inside ? -grid.background : grid.background;
      for (int z = 0; z < (dz ? 1 : 4); ++z)
        for (int y = 0; y < (dy ? 1 : 4); ++y)
          for (int x = 0; x < (dx ? 1 : 4); ++x)
            record[(x + 4 * dx) + record_stride_y * (y + 4 * dy) + record_stride_z * (z + 4 * dz)] =
                values ? values[bit_in_block(x, y, z)] : constant;
    }

    // See intersect/bernstein.hpp: 2^-20 of the largest sample, and what underflow may cost.
    float largest = 0, least = std::numeric_limits<float>::infinity();
    for (int s = 0; s < record_error; ++s) {
      const float size = std::fabs(record[s]);
      largest = std::max(largest, size);
      least = size > 0 ? std::min(least, size) : least;
    }
    record[record_error] = largest * 0x1p-20f + 0x1p-120f;
    record[record_least] = least;
    std::fill(record + record_least + 1, record + record_floats, 0.f);
  }
}

// The edge of the largest empty cube is one more than the least of those that begin at the seven next nodes
// of the octant, as in the maximal-square recurrence of dynamic programming.
void SurfaceBlocks::compute_leaps(int octant) {
  std::vector<std::uint8_t>& leaps = leaps_[static_cast<std::size_t>(octant)];
  leaps.assign(table_.size(), 0);
  const int dims[3] = {node_dims_.x, node_dims_.y, node_dims_.z};
  const int step[3] = {octant & 1 ? -1 : 1, octant & 2 ? -1 : 1, octant & 4 ? -1 : 1};
  const auto leap_at = [&](int x, int y, int z) -> int {
    if (x < 0 || y < 0 || z < 0 || x >= dims[0] || y >= dims[1] || z >= dims[2]) return 254;
    return leaps[static_cast<std::size_t>(x) +
                 static_cast<std::size_t>(dims[0]) *
                     (static_cast<std::size_t>(y) +
                      static_cast<std::size_t>(dims[1]) * static_cast<std::size_t>(z))];
  };
  // Visit nodes from the octant's far end.
  for (int k = dims[2] - 1; k >= 0; --k)
    for (int j = dims[1] - 1; j >= 0; --j)
      for (int i = dims[0] - 1; i >= 0; --i) {
        const int x = step[0] > 0 ? i : dims[0] - 1 - i;
        const int y = step[1] > 0 ? j : dims[1] - 1 - j;
        const int z = step[2] > 0 ? k : dims[2] - 1 - k;
        const std::size_t at = static_cast<std::size_t>(x) +
                               static_cast<std::size_t>(dims[0]) *
                                   (static_cast<std::size_t>(y) +
                                    static_cast<std::size_t>(dims[1]) * static_cast<std::size_t>(z));
        if (table_[at] != no_node) continue;
        int least = 254;
        for (int c = 1; c < 8; ++c)
          least = std::min(least, leap_at(x + (c & 1 ? step[0] : 0), y + (c & 2 ? step[1] : 0),
                                          z + (c & 4 ? step[2] : 0)));
        leaps[at] = static_cast<std::uint8_t>(least + 1);
      }
}

std::size_t SurfaceBlocks::bytes() const {
  return table_.size() * (sizeof(std::uint32_t) + 8) + nodes_.size() * sizeof(Node) +
         cells_.size() * sizeof(std::uint64_t) + records_.size() * sizeof(float);
}

} // namespace levelray
