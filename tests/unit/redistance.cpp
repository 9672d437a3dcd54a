#include "levelray/convert/redistance.hpp"

#include "levelray/convert/zero_set.hpp"
#include "levelray/core/error.hpp"
#include "levelray/core/parallel.hpp"
#include "levelray/grid/complete_blocks.hpp"
#include "levelray/mesh/triangle_bvh.hpp"
#include "support/catch.hpp"
#include "support/conversion.hpp"
#include "support/sphere_grid.hpp"

#include <cstring>
#include <random>

using namespace levelray;
using namespace levelray::test;
using Catch::Matchers::Contains;

namespace {

// The field at every sample of a box of 40^3 around the origin, in a band as wide as the box.
template <class Field>
BlockGrid dense_grid(const Field& field, double voxel_size = 1) {
  const double half_width = 100 * std::max(1.0, 1 / voxel_size); // values are in world units or in voxels
  BlockGrid grid =
      sample_grid(field, voxel_size, half_width, Box3d(Vec3d(-20 * voxel_size), Vec3d(20 * voxel_size)));
  complete_blocks(grid, std::uint64_t{1} << 30);
  return grid;
}

struct Differences {
  double worst = 0; // of active samples, voxels
  std::uint64_t active = 0, wrong_signs = 0, missing = 0;
};

// Against a signed distance (world units); samples within `unsure` voxels of the surface have no sign to
// speak of.
template <class Distance>
Differences differences(const BlockGrid& grid, const Distance& distance, double unsure) {
  Differences out;
  const double h = grid.transform.voxel_size;
  for_each_sample(grid, [&](int i, int j, int k, float value, bool is_active) {
    const double d = distance(grid.transform.to_world(Vec3d(i, j, k)));
    if (is_active) ++out.active, out.worst = std::max(out.worst, std::fabs(value - d) / h);
    if (!is_active) out.missing += std::fabs(d) < grid.background - unsure * h;
    if (std::fabs(d) > unsure * h) out.wrong_signs += std::signbit(value) != (d < 0);
  });
  return out;
}

} // namespace

TEST_CASE("a sphere in voxel units becomes a distance in world units") {
  for (const double h : {0.679, 1e-3, 40.0}) {
    CAPTURE(h);
    const double radius = 9.3 * h;
    const Vec3d centre = Vec3d(0.3, -0.7, 0.2) * h;
    const auto sphere = sphere_field(centre, radius);
    const BlockGrid source = dense_grid([&](const Vec3d& p) { return sphere(p) / h; }, h);
    RedistanceReport report;
    const BlockGrid grid = redistance(source, {}, &report);
    CHECK(!report.before.is_distance());
    CHECK(report.before.looks_like_voxel_units());
    CHECK(report.before.gradient_median * h == Approx(1).margin(0.05));
    CHECK(report.after.is_distance());
    CHECK(report.after.gradient_median == Approx(1).margin(0.03));
    CHECK(grid.half_width_voxels() == Approx(3).epsilon(1e-6));
    CHECK(grid.transform.voxel_size == h);
    // Interpolation on unit cells errs by at most the sum of the second derivatives over eight, which are 2 /
    // r together on a sphere of radius r, here at least 7.5 in surface cells; the zero set is found to 1/128.
    const double bound = 2 / 7.5 / 8 + 1.0 / 128 + 1e-5;
    const Differences d = differences(grid, sphere, bound);
    CHECK(d.worst < bound);
    CHECK(d.wrong_signs == 0);
    CHECK(d.missing == 0);
    CHECK(d.active > 5000);
    CHECK(report.largest_moved_voxels <
          2 * bound / 0.5); // both surfaces err; edges cross it at up to 60 degrees
  }
}

TEST_CASE("a field that grows unevenly becomes a distance") {
  const auto sphere = sphere_field(Vec3d(0.3, -0.7, 0.2), 11.2);
  const auto uneven =
      [&](const Vec3d& p) { // gradients of 0.5 at the surface and more away from it, as Mantaflow's
        const double d = sphere(p);
        return 0.5 * d + 0.3 * d * std::fabs(d);
      };
  RedistanceReport report;
  const BlockGrid grid = redistance(dense_grid(uneven), {}, &report);
  CHECK(!report.before.is_distance());
  CHECK(!report.before.looks_like_voxel_units());
  CHECK(report.after.is_distance());
  // As above, now for g(d) with g' = 0.5 + 0.6 |d| and g'' = 0.6 sign(d): in surface cells |d| < sqrt(3), so
  // the second derivatives' sum is below 0.6 + 2/r g', and the surface moves by that over eight over the
  // least gradient, 0.5.
  const double bound = (0.6 + 2 / 9.4 * (0.5 + 0.6 * 1.74)) / 8 / 0.5 + 1.0 / 128;
  const Differences d = differences(grid, sphere, bound);
  CHECK(d.worst < bound);
  CHECK(d.wrong_signs == 0);
  CHECK(d.missing == 0);
}

TEST_CASE("noise keeps the sides of its samples, and distances are those to its interpolated surface") {
  std::mt19937 random(99);
  std::uniform_real_distribution<double> noise(-0.7, 0.7);
  const auto sphere = sphere_field(Vec3d(0), 7.4);
  const BlockGrid source = dense_grid([&](const Vec3d& p) { return sphere(p) + noise(random); });
  const BlockGrid grid = redistance(source, {});

  // The surface by brute force: all cells, divided as finely as they can be.
  TriangleMesh mesh;
  for (int z = -15; z < 15; ++z)
    for (int y = -15; y < 15; ++y)
      for (int x = -15; x < 15; ++x) {
        std::array<float, 8> f;
        for (int c = 0; c < 8; ++c)
          f[static_cast<std::size_t>(c)] = source.value(x + (c & 1), y + (c >> 1 & 1), z + (c >> 2));
        append_zero_set(f, Vec3d(x, y, z), max_zero_set_divisions, mesh);
      }
  const TriangleBvh bvh(mesh);
  std::uint64_t active = 0, flipped = 0, off = 0, missing = 0;
  double squares = 0, worst = 0;
  for_each_sample(grid, [&](int i, int j, int k, float value, bool is_active) {
    flipped += (value < 0) != (source.value(i, j, k) < 0);
    const double d = std::sqrt(bvh.closest_point(Vec3d(i, j, k), 1000)->distance_squared);
    if (!is_active) {
      missing += d < grid.background - 0.1;
      return;
    }
    ++active;
    const double error = std::fabs(std::fabs(double{value}) - d);
    squares += error * error;
    // Twice 1/128, of the surface here and there. In noise a few cells need more than 4^3 parts for that:
    // where the gradient all but vanishes no bound holds, and half of a quarter of a cell must do.
    off += !(error < 2.0 / 128 + 1e-5);
    worst = std::max(worst, error);
  });
  CHECK(active > 4000);
  CHECK(flipped == 0);
  CHECK(missing == 0);
  CHECK(worst < 0.125);
  CHECK(static_cast<double>(off) < 0.01 * static_cast<double>(active));
  CHECK(std::sqrt(squares / static_cast<double>(active)) < 0.004);
}

TEST_CASE("what is a distance already stays as it is") {
  const BlockGrid flat =
      sample_grid([](const Vec3d& p) { return p.z - 3.3; }, 1, 5, Box3d(Vec3d(-12), Vec3d(12)));
  RedistanceReport report;
  BlockGrid source = flat;
  complete_blocks(source, std::uint64_t{1} << 30);
  CHECK(field_facts(source).is_distance());
  const BlockGrid grid = redistance(source, {}, &report);
  double worst = 0;
  for (int k = 1; k <= 5; ++k) worst = std::max(worst, std::fabs(grid.value(0, 0, k) - (k - 3.3)));
  CHECK(worst < 1e-5); // the kernel's bound, and the source's floats

  const BlockGrid ball = sphere_grid(25);
  CHECK(field_facts(ball).is_distance());
  redistance(ball, {}, &report);
  CHECK(report.largest_moved_voxels < 2 * (2 / 23.2 / 8 + 1.0 / 128)); // as for the sphere above
  CHECK(report.crossings > 5000);
}

TEST_CASE("a surface that ends with the samples is closed there") {
  // A dense block of negative samples up to its border: beyond is outside, at the background.
  const BlockGrid source = dense_grid([](const Vec3d& p) { return 0.5 * (p.z - 4.2); });
  REQUIRE(source.value(0, 0, -20) < 0);
  REQUIRE(source.value(0, 0, -21) > 0);
  const BlockGrid grid = redistance(source, {});
  CHECK(grid.value(0, 0, -20) < 0);
  CHECK(grid.value(0, 0, -21) > 0);
  CHECK(grid.value(0, 0, -24) == grid.background);
  CHECK(grid.value(0, 0, -10) == -grid.background);
  CHECK(grid.value(0, 0, 4) == Approx(-0.2).margin(1e-5));
}

TEST_CASE("redistancing gives the same bytes for 1, 2 and 7 threads") {
  const BlockGrid source =
      dense_grid([](const Vec3d& p) { return std::sin(p.x / 3) + std::cos(p.y / 2.5) + p.z / 9; });
  std::vector<float> first;
  for (const int threads : {1, 2, 7}) {
    const ThreadLimit limit(threads);
    const BlockGrid grid = redistance(source, {});
    if (first.empty()) first.assign(grid.values.begin(), grid.values.end());
    REQUIRE(grid.values.size() == first.size());
    CHECK(std::memcmp(grid.values.data(), first.data(), first.size() * sizeof(float)) == 0);
  }
}

TEST_CASE("the band is as wide as asked for") {
  const auto sphere = sphere_field(Vec3d(0), 9);
  const BlockGrid source = dense_grid([&](const Vec3d& p) { return 3 * sphere(p); });
  for (const double width : {1.0, 2.5, 6.0}) {
    CAPTURE(width);
    RedistanceOptions options;
    options.half_width_voxels = width;
    const Differences d = differences(redistance(source, options), sphere, 0.05);
    CHECK(d.missing == 0);
    CHECK(d.worst < 2 / 7.2 / 8 + 1.0 / 128);
  }
}

TEST_CASE("redistancing refuses what it cannot do") {
  const auto refused = [](const BlockGrid& grid, const RedistanceOptions& options, ErrorKind kind) {
    try {
      redistance(grid, options);
    } catch (const Error& error) {
      CHECK(error.kind() == kind);
      return std::string(error.what());
    }
    FAIL("no error");
    return std::string();
  };
  // Touches zero without changing its sign.
  BlockGrid touching = dense_grid([](const Vec3d& p) { return p.length(); });
  CHECK_THAT(refused(touching, {}, ErrorKind::bad_input), Contains("no surface"));
  RedistanceOptions options;
  options.max_memory = 10000;
  CHECK_THAT(refused(sphere_grid(10), options, ErrorKind::limit), Contains("--max-memory"));
  options = {};
  options.half_width_voxels = 0.5;
  refused(sphere_grid(10), options, ErrorKind::usage);
  options.half_width_voxels = NAN;
  refused(sphere_grid(10), options, ErrorKind::usage);
}

TEST_CASE("facts tell distances from scaled, voxel-unit and clamped fields") {
  const auto sphere = sphere_field(Vec3d(0.2, 0.1, -0.3), 9);
  const auto facts = [&](double factor, double h = 1) {
    return field_facts(dense_grid([&](const Vec3d& p) { return factor * sphere(p / h) * h; }, h));
  };
  CHECK(facts(1).is_distance());
  CHECK(facts(1).steep_share == 0);
  CHECK(facts(1.05).is_distance());
  CHECK(!facts(0.8).is_distance());
  CHECK(!facts(1.3).is_distance());
  CHECK(facts(1.3).steep_share > 0.1);
  CHECK(facts(0.8).steep_share == 0);
  CHECK(!facts(1.3).looks_like_voxel_units());
  CHECK(facts(1 / 0.2, 0.2).looks_like_voxel_units());
  CHECK(!facts(1, 0.2).looks_like_voxel_units()); // a distance
  CHECK_THAT(describe_field(facts(1 / 0.2, 0.2)),
             Contains("median length 4.9") || Contains("median length 5.0"));
  CHECK_THAT(describe_field(facts(1 / 0.2, 0.2)), Contains("near ones in voxels (1.0"));
  // Half of the distance on one side only.
  const FieldFacts uneven =
      field_facts(dense_grid([&](const Vec3d& p) { return sphere(p) * (sphere(p) < 0 ? 0.4 : 1); }));
  CHECK(!uneven.is_distance());
}
