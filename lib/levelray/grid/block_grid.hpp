// The sparse block grid (Bridson 2003; Jamriska 2010, section 3): a narrow-band signed distance field.
//
// A dense table of nodes (16^3 samples); a node has a 64-bit mask of stored blocks (4^3 samples) and says of
// the others whether they lie inside or outside. This is the whole band, for editing, exchange and measuring;
// what tracing needs is built from it (trace/level_set.hpp).
#pragma once

#include "levelray/core/bits.hpp"
#include "levelray/core/uninitialized_vector.hpp"
#include "levelray/grid/coords.hpp"

#include <bit>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace levelray {

class BlockGrid {
 public:
  // Table entries that are no node index: all 16^3 samples outside (+background) or inside (-background).
  static constexpr std::uint32_t outside_node = 0xFFFFFFFFu;
  static constexpr std::uint32_t inside_node = 0xFFFFFFFEu;

  struct Node {
    Vec3i coord;              // in nodes: the node's samples are 16*coord .. 16*coord+15
    std::uint64_t stored = 0; // blocks with samples
    std::uint64_t inside = 0; // blocks without samples that lie inside
    std::uint64_t first_block =
        0; // block index of the lowest stored bit; the others follow in the order of their bits
  };

  GridTransform transform;
  float background = 0; // world units, > 0: what a sample outside the band is worth, with its sign
  std::string name = "surface";
  // World units, where it is known: nowhere is the interpolant farther from the signed distance to the
  // surface that the grid was made from, cut at +-background. Not kept in files, which anybody may edit.
  std::optional<double> field_error;

  // The node table covers node coordinates node_min .. node_min + node_dims - 1, x fastest. Everything beyond
  // it is outside.
  Vec3i node_min{0, 0, 0};
  Vec3i node_dims{0, 0, 0};
  std::vector<std::uint32_t> node_table; // node_dims.x * y * z entries
  std::vector<Node> nodes;

  // Per stored block: 64 samples in world units (negative inside; never NaN, never -0), the mask of active
  // samples (those of the band; the others are +-background) and the mask of cells that the surface may cross
  // (see update_cell_masks).
  uninitialized_vector<float> values;
  std::vector<std::uint64_t> active;
  std::vector<std::uint64_t> cells;

  std::size_t block_count() const { return active.size(); }
  double half_width_voxels() const { return static_cast<double>(background) / transform.voxel_size; }
  std::uint64_t active_sample_count() const;
  std::size_t bytes() const; // memory held, in bytes

  // Index range (inclusive) of the active samples; empty when there are none.
  Box3i active_bounds() const;

  // The table entry of the node that holds sample (i,j,k).
  std::uint32_t node_entry(int i, int j, int k) const {
    const std::uint32_t x = static_cast<std::uint32_t>((i >> 4) - node_min.x);
    const std::uint32_t y = static_cast<std::uint32_t>((j >> 4) - node_min.y);
    const std::uint32_t z = static_cast<std::uint32_t>((k >> 4) - node_min.z);
    if (x >= static_cast<std::uint32_t>(node_dims.x) || y >= static_cast<std::uint32_t>(node_dims.y) ||
        z >= static_cast<std::uint32_t>(node_dims.z))
      return outside_node;
    return node_table[x + static_cast<std::size_t>(node_dims.x) *
                              (y + static_cast<std::size_t>(node_dims.y) * z)];
  }

  // The index of block `bit` of a node whose mask has it.
  static std::size_t block_index(const Node& node, int bit) {
    return node.first_block +
           static_cast<std::size_t>(count_bits(node.stored & ((std::uint64_t{1} << bit) - 1)));
  }

  // The 64 samples of the stored block that holds sample (i,j,k), or null; then *inside tells the side when
  // it is not null.
  const float* find_block(int i, int j, int k, bool* inside = nullptr) const {
    const std::uint32_t entry = node_entry(i, j, k);
    if (entry >= inside_node) {
      if (inside) *inside = entry == inside_node;
      return nullptr;
    }
    const Node& node = nodes[entry];
    const int bit = bit_in_node(i, j, k);
    if (node.stored >> bit & 1) return &values[block_index(node, bit) * samples_per_block];
    if (inside) *inside = node.inside >> bit & 1;
    return nullptr;
  }

  // The value of any sample, in world units.
  float value(int i, int j, int k) const {
    bool inside = false;
    const float* block = find_block(i, j, k, &inside);
    return block ? block[bit_in_block(i, j, k)] : inside ? -background : background;
  }
};

// Sets `cells`: bit set iff min corner <= 0 <= max corner, closed comparisons. The trilinear interpolant is a
// convex combination of the corners, so a clear bit proves that the surface does not meet the cell.
void update_cell_masks(BlockGrid& grid);

} // namespace levelray
