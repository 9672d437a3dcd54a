#include "support/sphere_grid.hpp"

#include "support/catch.hpp"

using namespace levelray;
using namespace levelray::test;

TEST_CASE("a sampled sphere holds the distance in its band and the background's sign elsewhere") {
  const BlockGrid grid = sphere_grid(25, 3, 0.5);
  CHECK(grid.node_dims.x < grid.node_dims.y);
  CHECK(grid.node_dims.y < grid.node_dims.z);
  CHECK(grid.node_min.x < 0);
  const auto field = sphere_field(Vec3d(-1.15, 0.85, 0.2), 12.5);
  std::uint64_t active = 0;
  bool equal = true;
  for (int k = -48; k < 48; ++k)
    for (int j = -48; j < 48; ++j)
      for (int i = -48; i < 48; ++i) {
        const float d = static_cast<float>(field(grid.transform.to_world(Vec3d(i, j, k))));
        const float expected = std::clamp(d, -1.5f, 1.5f);
        equal = equal && grid.value(i, j, k) == expected;
        active += std::fabs(expected) < 1.5f;
      }
  CHECK(equal);
  CHECK(active == grid.active_sample_count());
}

TEST_CASE("every cell of mixed signs has its block stored, in a band of half a voxel too") {
  const BlockGrid grid = sphere_grid(9, 0.5);
  for (int k = -20; k < 20; ++k)
    for (int j = -20; j < 20; ++j)
      for (int i = -20; i < 20; ++i) {
        int negative = 0;
        for (int c = 0; c < 8; ++c) negative += grid.value(i + (c & 1), j + (c >> 1 & 1), k + (c >> 2)) < 0;
        if (negative == 0 || negative == 8) continue;
        REQUIRE(grid.find_block(i, j, k) != nullptr);
      }
}
