#include "levelray/convert/distance_kernel.hpp"

#include "levelray/mesh/closest_point.hpp"
#include "support/catch.hpp"

#include <cmath>
#include <random>

using namespace levelray;

TEST_CASE("the kernel's distances equal the closest point's for triangles of any size and shape") {
  // Blocks at the corners of a node; triangles of 1e-7 to 1e3 voxels, some flattened to slivers and segments.
  const unsigned seed = 20;
  CAPTURE(seed);
  std::mt19937_64 rng(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(0, 1);
  const Vec3d center(7.5, -8.5, 1000007.5);
  double worst = 0;
  int compared = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    const auto random = [&] { return Vec3d(normal(rng), normal(rng), normal(rng)); };
    const double size = std::pow(10, uniform(rng) * 10 - 7),
                 flat = trial % 3 == 0 ? std::pow(10, -uniform(rng) * 12) : 1;
    const Vec3d start = center + random() * 4, edge = random() * size;
    const Vec3d a = start - edge * uniform(rng), b = a + edge,
                c = a + edge * uniform(rng) + random() * (size * flat);
    const TriangleFrame frame = make_triangle_frame(a, b, c, center, 20.6);
    const float origin[3] = {trial & 1 ? 4.5f : -7.5f, trial & 2 ? 4.5f : -7.5f, trial & 4 ? 4.5f : -7.5f};
    float squared[64];
    squared_distances_each(&frame, 1, origin, 1.0f, squared);
    for (int s = 0; s < 64; ++s) {
      const Vec3d p =
          center + Vec3d(origin[0] + static_cast<float>(s & 3), origin[1] + static_cast<float>(s >> 2 & 3),
                         origin[2] + static_cast<float>(s >> 4));
      const double exact = std::sqrt(closest_point_on_triangle(a, b, c, p).distance_squared);
      if (exact > 3) {
        REQUIRE(squared[s] > 8.99f);
        continue;
      }
      ++compared;
      worst = std::max(worst, std::abs(std::sqrt(double{squared[s]}) - exact));
    }
  }
  // convert/README.md: 1e-5 voxel.
  CHECK(worst < 1e-5);
  CHECK(compared > 30000);
}

TEST_CASE("masks of 64 comparisons have their bits in order") {
  float values[80] = {}, limits[64];
  for (int i = 0; i < 64; ++i)
    values[i] = static_cast<float>((i * 37) % 64), limits[i] = static_cast<float>(i);
  std::uint64_t below = 0, at_most = 0, along[3], expected[3] = {0, 0, 0};
  for (int i = 0; i < 64; ++i) {
    below |= std::uint64_t{values[i] < 20} << i;
    at_most |= std::uint64_t{values[i] <= limits[i]} << i;
    for (int axis = 0; axis < 3; ++axis)
      expected[axis] |= std::uint64_t{values[i] + values[i + (1 << 2 * axis)] > 64} << i;
  }
  CHECK(mask_below(values, 20) == below);
  CHECK(mask_at_most(values, limits) == at_most);
  pair_sums_above(values, 64, along);
  for (int axis = 0; axis < 3; ++axis) CHECK(along[axis] == expected[axis]);
}
