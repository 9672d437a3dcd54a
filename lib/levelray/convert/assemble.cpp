#include "levelray/convert/assemble.hpp"

#include "levelray/convert/distance_kernel.hpp"
#include "levelray/core/parallel.hpp"

#include <atomic>
#include <bit>
#include <cmath>
#include <limits>

namespace levelray {

namespace {

// What one node will store.
struct NodeStorage {
  std::uint64_t stored = 0, inside = 0;
  std::uint64_t first_block = 0;
};

// The sides of the block at block coordinates `block` (any node); beyond the table all is outside.
std::uint64_t sides_at(const Band& band, const std::vector<NodeSides>& sides, const Vec3i& block) {
  const Vec3i node(block.x >> 2, block.y >> 2, block.z >> 2);
  if (!band.box.contains(node)) return 0;
  return sides[band.box.index(node)].block(
      static_cast<std::size_t>((block.x & 3) | (block.y & 3) << 2 | (block.z & 3) << 4));
}

// Whether some cell of the block may be crossed: samples of its own or of the seven upper neighbours differ
// in side.
bool has_crossed_cell(const Band& band, const std::vector<NodeSides>& sides, const Vec3i& block) {
  const std::uint64_t own = sides_at(band, sides, block);
  if (own != 0 && own != ~std::uint64_t{0}) return true;
  for (int i = 1; i < 8; ++i) {
    // The samples of the neighbour that this block's cells touch: the low face, edge or corner towards it.
    std::uint64_t touched = ~std::uint64_t{0};
    for (int axis = 0; axis < 3; ++axis)
      if (i >> axis & 1) touched &= face_samples(axis, 0);
    const std::uint64_t other = sides_at(band, sides, block + Vec3i(i & 1, i >> 1 & 1, i >> 2)) & touched;
    if (other != (own & touched)) return true;
  }
  return false;
}

} // namespace

BlockGrid assemble_grid(Band& band, const std::vector<NodeSides>& sides, const GridTransform& transform,
                        double half_width_voxels, std::uint64_t* inside_samples) {
  BlockGrid grid;
  grid.transform = transform;
  grid.background = static_cast<float>(half_width_voxels * transform.voxel_size);
  if (grid.half_width_voxels() < half_width_voxels) // never less, as OpenVDB's check of level sets wants it
    grid.background = std::nextafter(grid.background, std::numeric_limits<float>::infinity());
  grid.node_min = band.box.node_min;
  grid.node_dims = band.box.dims;
  const std::size_t count = band.box.count();
  const float half_width = static_cast<float>(half_width_voxels);

  // Decide what each node stores. A uniform node next to a different one may still own crossed cells on its
  // high faces.
  std::vector<NodeStorage> storage(count);
  parallel_for(count, 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) {
      const Vec3i coord = band.box.coord(n);
      bool alone = sides[n].uniform() && band.node_at[n] == Band::untouched;
      for (int i = 1; i < 8 && alone; ++i) {
        const Vec3i next = coord + Vec3i(i & 1, i >> 1 & 1, i >> 2);
        const bool same = band.box.contains(next) ? sides[band.box.index(next)].uniform() &&
                                                        sides[band.box.index(next)].inside == sides[n].inside
                                                  : !sides[n].inside;
        alone = same;
      }
      if (alone) {
        storage[n].inside = sides[n].inside ? ~std::uint64_t{0} : 0;
        continue;
      }
      const NodeBand* node = band.node_at[n] == Band::untouched
                                 ? nullptr
                                 : &band.nodes[static_cast<std::size_t>(band.node_at[n])];
      for (int b = 0; b < 64; ++b) {
        const float* distance = node ? node->block_distance(b) : nullptr;
        const Vec3i block = coord * 4 + Vec3i(bit_x(b), bit_y(b), bit_z(b));
        const bool store =
            (distance && mask_below(distance, half_width)) || has_crossed_cell(band, sides, block);
        storage[n].stored |= std::uint64_t{store} << b;
        storage[n].inside |= std::uint64_t{!store && sides[n].block(static_cast<std::size_t>(b)) != 0} << b;
      }
    }
  });

  // Number nodes and blocks in table order.
  grid.node_table.resize(count);
  std::uint64_t blocks = 0;
  for (std::size_t n = 0; n < count; ++n) {
    const NodeStorage& s = storage[n];
    storage[n].first_block = blocks;
    if (!s.stored && (s.inside == 0 || s.inside == ~std::uint64_t{0})) {
      grid.node_table[n] = s.inside ? BlockGrid::inside_node : BlockGrid::outside_node;
      continue;
    }
    grid.node_table[n] = static_cast<std::uint32_t>(grid.nodes.size());
    grid.nodes.push_back({band.box.coord(n), s.stored, s.inside, blocks});
    blocks += static_cast<std::uint64_t>(std::popcount(s.stored));
  }

  // Write values: the distance, scaled and signed; beyond the half-width the background.
  grid.values.resize(blocks * samples_per_block);
  grid.active.resize(blocks);
  std::atomic<std::uint64_t> inside_count{0};
  parallel_for(count, 64, [&](std::size_t begin, std::size_t end) {
    std::uint64_t inside_here = 0;
    for (std::size_t n = begin; n < end; ++n) {
      NodeBand* node = band.node_at[n] == Band::untouched
                           ? nullptr
                           : &band.nodes[static_cast<std::size_t>(band.node_at[n])];
      std::size_t index = storage[n].first_block;
      for (std::uint64_t rest = storage[n].stored; rest; rest &= rest - 1, ++index) {
        const int b = std::countr_zero(rest);
        const float* distance = node ? node->block_distance(b) : nullptr;
        const std::uint64_t inside = sides[n].block(static_cast<std::size_t>(b));
        const std::uint64_t active = distance ? mask_below(distance, half_width) : 0;
        float* out = &grid.values[index * samples_per_block];
        for (int s = 0; s < samples_per_block; ++s) {
          float value = active >> s & 1 ? static_cast<float>(double{distance[s]} * transform.voxel_size)
                                        : grid.background;
          if ((inside >> s & 1) && value > 0) value = -value; // +0 stays +0
          out[s] = value;
        }
        grid.active[index] = active;
        inside_here += static_cast<std::uint64_t>(std::popcount(active & inside));
      }
      if (node) {
        node->distance = {};
        node->sheet_distance = {};
      }
    }
    inside_count += inside_here;
  });
  *inside_samples = inside_count;
  update_cell_masks(grid);
  return grid;
}

} // namespace levelray
