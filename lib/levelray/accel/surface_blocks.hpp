// The blocks of a grid that the surface crosses, laid out for rays.
//
// Three levels: a dense table of nodes (16^3 cells), per node a 64-bit mask of surface blocks (4^3 cells),
// per surface block a 64-bit mask of surface cells and the 5^3 samples that the block's cells touch, so that
// a cell never looks beyond its block (Jamriska 2010, sections 3 and 4.1, with one more level and the apron).
// Blocks are sorted by node, then bit: a child is its node's first block plus a population count.
//
// Empty nodes know, for each of the eight octants of directions, the edge (in nodes) of the largest empty
// cube that begins with them and grows that way: a ray may leap to the far side of it. What lies beyond the
// table counts as empty.
#pragma once

#include "levelray/grid/block_grid.hpp"

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

namespace levelray {

class SurfaceBlocks {
 public:
  struct Node {
    std::uint64_t blocks = 0; // mask of surface blocks
    std::uint64_t first = 0;  // index of the lowest of them
  };
  // 125 samples, x fastest; then the bound CellSegment::error for the block's cells, its least sample, and a
  // float of padding: 512 bytes that begin at a cache line.
  static constexpr int record_floats = 128;
  static constexpr int record_error = 125, record_least = 126;
  static constexpr int record_stride_y = 5, record_stride_z = 25;

  SurfaceBlocks() = default;
  // Needs up-to-date grid.cells. The same bytes for any number of threads.
  explicit SurfaceBlocks(const BlockGrid& grid);

  bool empty() const { return nodes_.empty(); }
  // The table covers the bounding box of the nodes that have surface blocks, x fastest.
  const Vec3i& node_min() const { return node_min_; }
  const Vec3i& node_dims() const { return node_dims_; }
  // The bounding box of the surface blocks, in blocks from the table's lowest corner; `end` is excluded.
  const Vec3i& block_min() const { return block_min_; }
  const Vec3i& block_end() const { return block_end_; }

  // By position in the table. `leap` is 0 exactly where there is a node; octant bit a is set for rays towards
  // lower coordinates of axis a.
  int leap(int octant, std::size_t at) const { return leaps_[static_cast<std::size_t>(octant)][at]; }
  const std::uint8_t* leaps(int octant) const { return leaps_[static_cast<std::size_t>(octant)].data(); }
  const Node& node(std::size_t at) const { return nodes_[table_[at]]; }

  std::size_t block_count() const { return cells_.size(); }
  // At least all samples' absolute values.
  float largest_sample() const { return largest_sample_; }
  // The least absolute value of a surface block's samples that are not 0; infinite where all are.
  float least_sample() const { return least_sample_; }
  std::uint64_t cells(std::size_t block) const { return cells_[block]; }
  const float* record(std::size_t block) const { return &records_[block * record_floats]; }
  // The record of the block that holds a cell, or null where the surface crosses no cell of that block.
  const float* find_record(const Vec3i& cell) const {
    const auto x = static_cast<std::uint32_t>((cell.x >> 4) - node_min_.x),
               y = static_cast<std::uint32_t>((cell.y >> 4) - node_min_.y),
               z = static_cast<std::uint32_t>((cell.z >> 4) - node_min_.z);
    const auto dims_x = static_cast<std::uint32_t>(node_dims_.x),
               dims_y = static_cast<std::uint32_t>(node_dims_.y);
    if (x >= dims_x || y >= dims_y || z >= static_cast<std::uint32_t>(node_dims_.z)) return nullptr;
    const std::size_t at = x + std::size_t{dims_x} * (y + std::size_t{dims_y} * z);
    if (leaps_[0][at]) return nullptr;
    const Node& found = node(at);
    const int bit = bit_in_node(cell.x, cell.y, cell.z);
    if (!(found.blocks >> bit & 1)) return nullptr;
    return record(found.first + count_bits(found.blocks & ((std::uint64_t{1} << bit) - 1)));
  }
  std::size_t bytes() const;

 private:
  void index_nodes(const BlockGrid& grid);
  void copy_samples(const BlockGrid& grid, std::size_t node, const BlockGrid::Node& source);
  void compute_leaps(int octant);

  float largest_sample_ = 0, least_sample_ = std::numeric_limits<float>::infinity();
  Vec3i node_min_{0, 0, 0}, node_dims_{0, 0, 0}, block_min_{0, 0, 0}, block_end_{0, 0, 0};
  std::vector<std::uint32_t> table_; // node index; meaningless where leap > 0
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> sources_; // per node its index in the grid; only while building
  std::array<std::vector<std::uint8_t>, 8> leaps_;
  uninitialized_vector<std::uint64_t> cells_;
  uninitialized_vector<float> records_;
};

} // namespace levelray
