// Differences of grids, against changes made by hand.
#include "levelray/measure/compare_grids.hpp"
#include "support/catch.hpp"
#include "support/sphere_grid.hpp"

#include <cmath>

using namespace levelray;
using namespace levelray::test;

namespace {

// The block that holds the sample, to be changed.
std::size_t block_at(const BlockGrid& grid, int i, int j, int k) {
  const float* values = grid.find_block(i, j, k);
  REQUIRE(values);
  return static_cast<std::size_t>(values - grid.values.data()) / samples_per_block;
}

} // namespace

TEST_CASE("a grid equals itself") {
  const BlockGrid grid = sphere_grid(10);
  const GridComparison r = compare_grids(grid, grid);
  CHECK(r.mismatch.empty());
  CHECK(r.verdict == Verdict::pass);
  CHECK(r.samples.total() == grid.active_sample_count());
  CHECK(r.active_a == grid.active_sample_count());
  CHECK(r.active_b == grid.active_sample_count());
  CHECK(r.max == 0);
  CHECK(r.remarks.empty());
}

TEST_CASE("differences of samples are counted in voxels, with their place") {
  const double voxel = 0.5;
  const BlockGrid a = sphere_grid(10, 3, voxel);
  BlockGrid b = a;
  const auto sample = [](BlockGrid& grid, int i, int j, int k) -> float& {
    return grid.values[block_at(grid, i, j, k) * samples_per_block +
                       static_cast<std::size_t>(bit_in_block(i, j, k))];
  };
  sample(b, 8, 2, 0) += 0.25f; // half a voxel, outside
  const double depth = -a.value(6, 2, 0) / voxel;
  REQUIRE((depth > 1 && depth < 2)); // inside, in the band
  sample(b, 6, 2, 0) = -a.value(6, 2, 0);
  const GridComparison r = compare_grids(a, b);
  CHECK(r.samples.failed() == 2);
  CHECK(r.max == 2 * depth);
  CHECK(r.max_at == Vec3i(6, 2, 0));
  CHECK(r.max_position == Vec3d(3, 1, 0));
  const double n = static_cast<double>(r.samples.total());
  CHECK(r.mean == Approx((2 * depth + 0.5) / n).epsilon(1e-6)); // the float sum of the half voxel is rounded
  CHECK(r.rms == Approx(std::sqrt((4 * depth * depth + 0.25) / n)).epsilon(1e-6));
  CHECK(r.sign_flips == 1);
  CHECK(r.verdict == Verdict::failure);
  Thresholds t;
  t.fail = 2 * depth;
  CHECK(compare_grids(a, b, t).verdict == Verdict::warning);
}

TEST_CASE("samples active in one grid only are compared with the other's background") {
  const BlockGrid narrow = sphere_grid(10, 2), wide = sphere_grid(10, 3);
  const GridComparison r = compare_grids(narrow, wide);
  CHECK(r.only_in_a == 0);
  CHECK(r.only_in_b == wide.active_sample_count() - narrow.active_sample_count());
  CHECK(r.samples.total() == wide.active_sample_count());
  CHECK(r.sign_flips == 0);
  CHECK(r.inactive_flips == 0);
  CHECK(r.max <= 1);
  CHECK(r.max > 0.9);
  CHECK(r.background_difference == Approx(1).epsilon(1e-6));
  CHECK(r.verdict == Verdict::failure);
  Thresholds t;
  t.fail = 1.001;
  CHECK(compare_grids(narrow, wide, t).verdict == Verdict::warning);
  const GridComparison back = compare_grids(wide, narrow);
  CHECK(back.only_in_a == r.only_in_b);
  CHECK(back.samples.total() == r.samples.total());
  CHECK(back.max == r.max);
}

TEST_CASE("an interior taken for outside is a difference though no sample of it is stored") {
  const BlockGrid a = sphere_grid(40, 3); // wide enough for whole nodes inside
  BlockGrid b = a;
  std::uint64_t nodes = 0, blocks = 0;
  for (std::uint32_t& entry : b.node_table)
    if (entry == BlockGrid::inside_node) {
      entry = BlockGrid::outside_node;
      ++nodes;
    }
  for (BlockGrid::Node& node : b.nodes) {
    blocks += static_cast<std::uint64_t>(std::popcount(node.inside));
    node.inside = 0;
  }
  REQUIRE(nodes > 0);
  REQUIRE(blocks > 0);
  const GridComparison r = compare_grids(a, b);
  CHECK(r.inactive_flips == nodes * 4096 + blocks * 64);
  CHECK(r.samples.failed() == r.inactive_flips);
  CHECK(r.samples.total() == a.active_sample_count() + r.inactive_flips);
  CHECK(r.max == Approx(6).epsilon(1e-6)); // from -3 to 3 voxels
  CHECK(r.sign_flips == 0);
  CHECK(r.verdict == Verdict::failure);
}

TEST_CASE("beyond the other's table a grid is compared with outside") {
  const BlockGrid small = sphere_grid(10), large = sphere_grid(30);
  const GridComparison r = compare_grids(small, large), back = compare_grids(large, small);
  CHECK(r.samples.total() == back.samples.total());
  CHECK(r.active_b == large.active_sample_count());
  CHECK(r.only_in_b == back.only_in_a);
  CHECK(r.inactive_flips == back.inactive_flips);
  CHECK(r.max == back.max);
}

TEST_CASE("transforms must agree to the threshold, at the farthest sample") {
  const BlockGrid a = sphere_grid(10, 3, 0.1);
  BlockGrid b = a;
  b.transform.origin.x += 0.1;
  CHECK_THAT(compare_grids(a, b).mismatch, Catch::Contains("different transforms: voxel 0.1,"));
  CHECK(compare_grids(a, b).verdict == Verdict::failure);
  b = a;
  b.transform.voxel_size *= 1 + 1e-9; // 32 samples from the origin: 3e-8 voxels
  CHECK(compare_grids(a, b).verdict == Verdict::pass);
  CHECK(compare_grids(a, b).remarks.size() == 1);
  b.transform.voxel_size = a.transform.voxel_size * (1 + 1e-6);
  CHECK_FALSE(compare_grids(a, b).mismatch.empty());
  Thresholds t;
  t.fail = 1e-3;
  CHECK(compare_grids(a, b, t).mismatch.empty());
}
