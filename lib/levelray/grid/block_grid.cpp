#include "levelray/grid/block_grid.hpp"

#include "levelray/core/parallel.hpp"

#include <algorithm>

namespace levelray {

std::uint64_t BlockGrid::active_sample_count() const {
  std::uint64_t count = 0;
  for (const std::uint64_t mask : active) count += static_cast<std::uint64_t>(std::popcount(mask));
  return count;
}

std::size_t BlockGrid::bytes() const {
  return values.size() * sizeof(float) + (active.size() + cells.size()) * sizeof(std::uint64_t) +
         nodes.size() * sizeof(Node) + node_table.size() * sizeof(std::uint32_t);
}

Box3i BlockGrid::active_bounds() const {
  Box3i box;
  for (const Node& node : nodes) {
    std::size_t block = node.first_block;
    for (std::uint64_t rest = node.stored; rest; rest &= rest - 1, ++block) {
      const int bit = std::countr_zero(rest);
      const Vec3i corner = node.coord * node_dim + Vec3i(bit_x(bit), bit_y(bit), bit_z(bit)) * block_dim;
      for (std::uint64_t samples = active[block]; samples; samples &= samples - 1) {
        const int s = std::countr_zero(samples);
        box.extendBy(corner + Vec3i(bit_x(s), bit_y(s), bit_z(s)));
      }
    }
  }
  return box;
}

namespace {

// Masks of the samples of a block that are <= 0 and >= 0.
struct SignMasks {
  std::uint64_t not_positive = 0, not_negative = 0;
};

SignMasks sign_masks(const float* values) {
  SignMasks masks;
  for (int s = 0; s < samples_per_block; ++s) {
    masks.not_positive |= std::uint64_t{values[s] <= 0} << s;
    masks.not_negative |= std::uint64_t{values[s] >= 0} << s;
  }
  return masks;
}

constexpr std::uint64_t x3_bits = 0x8888888888888888ull; // samples with x = 3, y = 3, z = 3
constexpr std::uint64_t y3_bits = 0xF000F000F000F000ull;
constexpr std::uint64_t z3_bits = 0xFFFF000000000000ull;

// The union, over the corners of each cell, of a property of samples: own block and the seven neighbours at
// +x, +y, +xy, +z, ….
std::uint64_t spread_to_cells(const std::uint64_t (&masks)[8]) {
  // Along x: a cell takes bit s and s+1; at x = 3 the next one comes from x = 0 of the block at +x.
  std::uint64_t along_x[4];
  for (int i = 0; i < 4; ++i) {
    const std::uint64_t own = masks[2 * i], next = masks[2 * i + 1];
    along_x[i] = own | (own >> 1 & ~x3_bits) | (next << 3 & x3_bits);
  }
  std::uint64_t along_y[2];
  for (int i = 0; i < 2; ++i) {
    const std::uint64_t own = along_x[2 * i], next = along_x[2 * i + 1];
    along_y[i] = own | (own >> 4 & ~y3_bits) | (next << 12 & y3_bits);
  }
  return along_y[0] | along_y[0] >> 16 | (along_y[1] << 48 & z3_bits);
}

} // namespace

void update_cell_masks(BlockGrid& grid) {
  const std::size_t blocks = grid.block_count();
  std::vector<SignMasks> signs(blocks);
  parallel_for(blocks, 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) signs[b] = sign_masks(&grid.values[b * samples_per_block]);
  });

  grid.cells.assign(blocks, 0);
  parallel_for(grid.nodes.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) {
      const BlockGrid::Node& node = grid.nodes[n];
      std::size_t block = node.first_block;
      for (std::uint64_t rest = node.stored; rest; rest &= rest - 1, ++block) {
        const int bit = std::countr_zero(rest);
        const Vec3i corner = node.coord * node_dim + Vec3i(bit_x(bit), bit_y(bit), bit_z(bit)) * block_dim;
        std::uint64_t not_positive[8], not_negative[8];
        for (int i = 0; i < 8; ++i) {
          SignMasks masks;
          if (i == 0) {
            masks = signs[block];
          } else {
            bool inside = false;
            const float* values = grid.find_block(corner.x + (i & 1) * 4, corner.y + (i >> 1 & 1) * 4,
                                                  corner.z + (i >> 2) * 4, &inside);
            if (values)
              masks = signs[static_cast<std::size_t>(values - grid.values.data()) / samples_per_block];
            else
              masks = inside ? SignMasks{~std::uint64_t{0}, 0} : SignMasks{0, ~std::uint64_t{0}};
          }
          not_positive[i] = masks.not_positive;
          not_negative[i] = masks.not_negative;
        }
        grid.cells[block] = spread_to_cells(not_positive) & spread_to_cells(not_negative);
      }
    }
  });
}

} // namespace levelray
