#include "levelray/grid/block_grid.hpp"
#include "support/catch.hpp"

using namespace levelray;

namespace {

// Two blocks side by side along y in the node (-1,0,2), the rest of the node outside.
BlockGrid two_blocks(float left, float right) {
  BlockGrid grid;
  grid.background = 3;
  grid.node_min = Vec3i(-1, 0, 2);
  grid.node_dims = Vec3i(1, 1, 1);
  grid.node_table = {0};
  BlockGrid::Node node;
  node.coord = Vec3i(-1, 0, 2);
  node.stored = std::uint64_t{1} << bit_in_node(0, 4, 8) | std::uint64_t{1} << bit_in_node(0, 8, 8);
  grid.nodes = {node};
  grid.values.resize(2 * samples_per_block);
  std::fill_n(grid.values.begin(), samples_per_block, left);
  std::fill_n(grid.values.begin() + samples_per_block, samples_per_block, right);
  grid.active.assign(2, ~std::uint64_t{0});
  update_cell_masks(grid);
  return grid;
}

} // namespace

TEST_CASE("a sample is found in its block, and the background everywhere else") {
  const BlockGrid grid = two_blocks(-1, 2);
  CHECK(grid.value(-16, 4, 40) == -1);
  CHECK(grid.value(-13, 7, 43) == -1);
  CHECK(grid.value(-16, 8, 40) == 2);
  CHECK(grid.value(-12, 4, 40) == 3);
  CHECK(grid.value(1000000, -5, 7) == 3);
  CHECK(grid.active_sample_count() == 128);
  CHECK(grid.active_bounds().min == Vec3i(-16, 4, 40));
  CHECK(grid.active_bounds().max == Vec3i(-13, 11, 43));
}

TEST_CASE("a cell's bit is set exactly when its corners have both signs") {
  const BlockGrid grid = two_blocks(-1, 2);
  for (int bit = 0; bit < 64; ++bit) {
    const bool leaves_left = bit_x(bit) == 3 || bit_y(bit) == 3 || bit_z(bit) == 3;
    CHECK((grid.cells[0] >> bit & 1) == leaves_left);
    CHECK((grid.cells[1] >> bit & 1) == 0);
  }
}

TEST_CASE("a zero corner counts for both signs") {
  CHECK(two_blocks(2, 0).cells[0] == 0xF000F000F000F000ull);
  CHECK(two_blocks(0, 1).cells[0] == ~std::uint64_t{0});
}
