#include "levelray/grid/complete_blocks.hpp"

#include "levelray/core/error.hpp"
#include "levelray/core/parallel.hpp"

#include <algorithm>
#include <array>

namespace levelray {

namespace {

enum SignBits : unsigned { has_not_positive = 1, has_not_negative = 2 };

// A stored block's samples as its neighbours' cells see them: for each direction c (bit 0: from +x, 1: +y, 2:
// +z), the signs met on the block's face, edge or corner that the cells of the block at -c touch. Two bits
// per direction.
std::uint16_t sign_summary(const float* values) {
  unsigned summary = 0;
  for (int s = 0; s < samples_per_block; ++s) {
    const unsigned bits = (values[s] <= 0 ? has_not_positive : 0u) | (values[s] >= 0 ? has_not_negative : 0u);
    for (int c = 0; c < 8; ++c) {
      if ((c & 1 && bit_x(s)) || (c & 2 && bit_y(s)) || (c & 4 && bit_z(s))) continue;
      summary |= bits << 2 * c;
    }
  }
  return static_cast<std::uint16_t>(summary);
}

struct Missing {
  std::size_t entry;    // of the node table
  std::uint64_t blocks; // to be stored in addition
};

class Search {
 public:
  explicit Search(const BlockGrid& grid) : grid_(grid), summaries_(grid.block_count()) {
    parallel_for(summaries_.size(), 4096, [&](std::size_t begin, std::size_t end) {
      for (std::size_t b = begin; b < end; ++b)
        summaries_[b] = sign_summary(&grid.values[b * samples_per_block]);
    });
  }

  // The missing blocks of one node of the table.
  std::uint64_t missing(const Vec3i& node) const {
    const std::array<std::uint32_t, 8> entries = neighbourhood(node);
    const std::uint32_t own = entries[0];
    if (own >= BlockGrid::inside_node &&
        std::all_of(entries.begin(), entries.end(), [&](std::uint32_t e) { return e == own; }))
      return 0;

    std::uint64_t result = 0;
    const std::uint64_t stored = own >= BlockGrid::inside_node ? 0 : grid_.nodes[own].stored;
    for (int bit = 0; bit < 64; ++bit) {
      if (stored >> bit & 1) continue;
      unsigned signs = 0;
      for (int c = 0; c < 8; ++c) {
        const int x = bit_x(bit) + (c & 1), y = bit_y(bit) + (c >> 1 & 1), z = bit_z(bit) + (c >> 2);
        const std::uint32_t entry =
            entries[static_cast<std::size_t>((x >> 2) | (y >> 2) << 1 | (z >> 2) << 2)];
        signs |= signs_of(entry, (x & 3) | (y & 3) << 2 | (z & 3) << 4, c);
      }
      if (signs == (has_not_positive | has_not_negative)) result |= std::uint64_t{1} << bit;
    }
    return result;
  }

 private:
  std::array<std::uint32_t, 8> neighbourhood(const Vec3i& node) const {
    std::array<std::uint32_t, 8> entries;
    for (int c = 0; c < 8; ++c) {
      const Vec3i at = node - grid_.node_min + Vec3i(c & 1, c >> 1 & 1, c >> 2);
      const Vec3i& dims = grid_.node_dims;
      entries[static_cast<std::size_t>(c)] =
          at.x >= dims.x || at.y >= dims.y || at.z >= dims.z
              ? BlockGrid::outside_node
              : grid_.node_table[at.x + static_cast<std::size_t>(dims.x) *
                                            (at.y + static_cast<std::size_t>(dims.y) * at.z)];
    }
    return entries;
  }

  unsigned signs_of(std::uint32_t entry, int bit, int direction) const {
    if (entry == BlockGrid::outside_node) return has_not_negative;
    if (entry == BlockGrid::inside_node) return has_not_positive;
    const BlockGrid::Node& node = grid_.nodes[entry];
    if (node.stored >> bit & 1) return summaries_[BlockGrid::block_index(node, bit)] >> 2 * direction & 3u;
    return node.inside >> bit & 1 ? has_not_positive : has_not_negative;
  }

  const BlockGrid& grid_;
  std::vector<std::uint16_t> summaries_;
};

// Every table entry with something missing, in the table's order.
std::vector<Missing> find_missing(const BlockGrid& grid) {
  const Search search(grid);
  const std::size_t rows =
      static_cast<std::size_t>(grid.node_dims.y) * static_cast<std::size_t>(grid.node_dims.z);
  std::vector<std::vector<Missing>> of_row(rows);
  parallel_for(rows, 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row)
      for (int x = 0; x < grid.node_dims.x; ++x) {
        const Vec3i local(x, static_cast<int>(row % static_cast<std::size_t>(grid.node_dims.y)),
                          static_cast<int>(row / static_cast<std::size_t>(grid.node_dims.y)));
        if (const std::uint64_t blocks = search.missing(grid.node_min + local))
          of_row[row].push_back(
              {row * static_cast<std::size_t>(grid.node_dims.x) + static_cast<std::size_t>(x), blocks});
      }
  });
  std::vector<Missing> all;
  for (const std::vector<Missing>& row : of_row) all.insert(all.end(), row.begin(), row.end());
  return all;
}

// The grid with the missing blocks, in the order of the table.
void rebuild(BlockGrid& grid, const std::vector<Missing>& missing, std::uint64_t added) {
  std::vector<BlockGrid::Node> nodes;
  nodes.reserve(grid.nodes.size() + missing.size());
  uninitialized_vector<float> values;
  values.reserve(grid.values.size() + added * samples_per_block);
  std::vector<std::uint64_t> active;
  active.reserve(grid.active.size() + added);

  auto next = missing.begin();
  for (std::size_t i = 0; i < grid.node_table.size(); ++i) {
    const std::uint32_t entry = grid.node_table[i];
    const std::uint64_t extra = next != missing.end() && next->entry == i ? (next++)->blocks : 0;
    if (entry >= BlockGrid::inside_node && !extra) continue;

    BlockGrid::Node old; // what the node was
    if (entry < BlockGrid::inside_node) {
      old = grid.nodes[entry];
    } else {
      const std::size_t nx = static_cast<std::size_t>(grid.node_dims.x),
                        ny = static_cast<std::size_t>(grid.node_dims.y);
      old.coord = grid.node_min + Vec3i(static_cast<int>(i % nx), static_cast<int>(i / nx % ny),
                                        static_cast<int>(i / nx / ny));
      old.inside = entry == BlockGrid::inside_node ? ~std::uint64_t{0} : 0;
    }
    BlockGrid::Node node = old;
    node.stored |= extra;
    node.inside &= ~extra;
    node.first_block = active.size();
    for (std::uint64_t rest = node.stored; rest; rest &= rest - 1) {
      const int bit = std::countr_zero(rest);
      if (extra >> bit & 1) {
        values.insert(values.end(), samples_per_block,
                      old.inside >> bit & 1 ? -grid.background : grid.background);
        active.push_back(0);
      } else {
        const std::size_t block = BlockGrid::block_index(old, bit);
        const float* first = &grid.values[block * samples_per_block];
        values.insert(values.end(), first, first + samples_per_block);
        active.push_back(grid.active[block]);
      }
    }
    grid.node_table[i] = static_cast<std::uint32_t>(nodes.size());
    nodes.push_back(node);
  }
  grid.nodes = std::move(nodes);
  grid.values = std::move(values);
  grid.active = std::move(active);
}

} // namespace

std::uint64_t complete_blocks(BlockGrid& grid, std::uint64_t max_bytes) {
  const std::vector<Missing> missing = find_missing(grid);
  std::uint64_t added = 0;
  for (const Missing& m : missing) added += static_cast<std::uint64_t>(std::popcount(m.blocks));
  const std::uint64_t bytes_per_block = samples_per_block * sizeof(float) + 2 * sizeof(std::uint64_t);
  if (grid.bytes() + missing.size() * sizeof(BlockGrid::Node) + added * bytes_per_block > max_bytes)
    throw Error(ErrorKind::limit, "the blocks along the surface alone need more memory than allowed: " +
                                      std::to_string(added) + " to add");
  if (added) rebuild(grid, missing, added);
  update_cell_masks(grid);
  return added;
}

} // namespace levelray
