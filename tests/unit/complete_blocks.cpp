#include "levelray/grid/complete_blocks.hpp"

#include "levelray/core/error.hpp"
#include "support/catch.hpp"
#include "support/sphere_grid.hpp"

#include <cstring>
#include <limits>
#include <random>

using namespace levelray;
using namespace levelray::test;

namespace {

constexpr std::uint64_t no_limit = std::numeric_limits<std::uint64_t>::max();

// Random nodes: tiles and blocks of both signs in the middle, outside all around, so that the table's margin
// is there.
BlockGrid random_grid(unsigned seed) {
  std::mt19937 random(seed);
  BlockGrid grid;
  grid.background = 2;
  grid.node_min = Vec3i(-2, -3, 1);
  grid.node_dims = Vec3i(4, 5, 6);
  for (int n = 0; n < 4 * 5 * 6; ++n) {
    const Vec3i at(n % 4, n / 4 % 5, n / 20);
    const bool rim = at.x == 0 || at.y == 0 || at.z == 0;
    const unsigned kind = rim ? 0u : static_cast<unsigned>(random() % 3);
    if (kind < 2) {
      grid.node_table.push_back(kind ? BlockGrid::inside_node : BlockGrid::outside_node);
      continue;
    }
    BlockGrid::Node node;
    node.coord = grid.node_min + at;
    node.stored = std::uint64_t{random()} & random(); // few
    node.inside = (std::uint64_t{random()} << 32 | random()) & ~node.stored;
    node.first_block = grid.active.size();
    for (int b = 0; b < std::popcount(node.stored); ++b) {
      const unsigned signs = random() % 4; // blocks of one sign, of the other, mixed, with zeros
      for (int s = 0; s < samples_per_block; ++s) {
        const float v = std::uniform_real_distribution<float>(0.1f, 1.9f)(random);
        grid.values.push_back(signs == 0                        ? v
                              : signs == 1                      ? -v
                              : random() % 9 == 0 && signs == 2 ? 0
                              : random() % 2                    ? v
                                                                : -v);
      }
      grid.active.push_back(~std::uint64_t{0});
    }
    grid.node_table.push_back(static_cast<std::uint32_t>(grid.nodes.size()));
    grid.nodes.push_back(node);
  }
  return grid;
}

} // namespace

TEST_CASE("every cell without one strict sign has its block after completion, and no sample changes") {
  for (const unsigned seed : {1u, 2u, 3u}) {
    CAPTURE(seed);
    const BlockGrid before = random_grid(seed);
    BlockGrid after = before;
    const std::uint64_t added = complete_blocks(after, no_limit);
    CHECK(added > 0);
    CHECK(after.block_count() == before.block_count() + added);
    CHECK(after.active_sample_count() == before.active_sample_count());
    CHECK(after.cells.size() == after.block_count());

    // Plain search over all cells, on values alone.
    const Vec3i low = before.node_min * node_dim - Vec3i(2, 2, 2),
                high = (before.node_min + before.node_dims) * node_dim + Vec3i(2, 2, 2);
    std::size_t changed = 0, missing = 0, needed = 0;
    std::vector<std::uint64_t> blocks_needed(after.block_count());
    for (int k = low.z; k < high.z; ++k)
      for (int j = low.y; j < high.y; ++j)
        for (int i = low.x; i < high.x; ++i) {
          changed += before.value(i, j, k) != after.value(i, j, k);
          int negative = 0, positive = 0;
          for (int c = 0; c < 8; ++c) {
            const float v = before.value(i + (c & 1), j + (c >> 1 & 1), k + (c >> 2));
            negative += v < 0;
            positive += v > 0;
          }
          if (negative == 8 || positive == 8) continue;
          const float* block = after.find_block(i, j, k);
          if (!block) {
            ++missing;
            continue;
          }
          const std::size_t b = static_cast<std::size_t>(block - after.values.data()) / samples_per_block;
          blocks_needed[b] |= std::uint64_t{1} << bit_in_block(i, j, k);
        }
    CHECK(changed == 0);
    CHECK(missing == 0);
    for (std::size_t b = 0; b < after.block_count(); ++b) needed += after.cells[b] != blocks_needed[b];
    CHECK(needed == 0); // the cell masks are these cells exactly
    // Nothing beyond need: an added block has such a cell.
    std::size_t useless = 0;
    for (std::size_t b = 0; b < after.block_count(); ++b)
      useless += after.active[b] == 0 && blocks_needed[b] == 0;
    CHECK(useless == 0);

    CHECK(complete_blocks(after, no_limit) == 0);
  }
}

TEST_CASE("a band of three voxels needs no blocks, and stays as it is") {
  const BlockGrid before = sphere_grid(12);
  BlockGrid after = before;
  CHECK(complete_blocks(after, no_limit) == 0);
  CHECK(after.values == before.values);
  CHECK(after.node_table == before.node_table);
}

TEST_CASE("completion keeps to its budget") {
  BlockGrid grid = random_grid(1);
  const std::size_t blocks = grid.block_count();
  CHECK_THROWS_AS(complete_blocks(grid, grid.bytes() + 100), Error);
  CHECK(grid.block_count() == blocks);
}
