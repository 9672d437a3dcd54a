// Rays with extreme numbers: the right answer or a miss, no NaN, no hang.
#include "levelray/core/error.hpp"
#include "levelray/intersect/intersectors.hpp"
#include "levelray/trace/level_set.hpp"
#include "support/catch.hpp"
#include "support/trace_fixtures.hpp"

#include <cfloat>
#include <limits>

using namespace levelray;
using namespace levelray::test;

namespace {

constexpr double inf = std::numeric_limits<double>::infinity();
constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();

// A half space x <= 5.25 within a box: f = x - 5.25 where it matters, so hits are known.
const BlockGrid& wall() {
  static const BlockGrid grid = sample_grid([](const Vec3d& p) { return p.x - 5.25; }, 1, 3,
                                            Box3d(Vec3d(-20, -12, -9), Vec3d(12, 17, 20)));
  return grid;
}

WorldRay ray_from(const Vec3d& origin, const Vec3d& direction, double t_min = 0, double t_max = inf) {
  WorldRay ray;
  ray.origin = origin, ray.direction = direction, ray.t_min = t_min, ray.t_max = t_max;
  return ray;
}

} // namespace

TEMPLATE_LIST_TEST_CASE("directions of any length hit", "", Intersectors) {
  const LevelSet level_set(wall());
  const double half_cell = TestType::name == "midpoint" ? 0.5 : 0x1p-40;
  for (const double length : {1.0, 1e-20, 1e20, 1e-280, 1e300}) {
    CAPTURE(length);
    const Hit hit =
        closest_hit(level_set, ray_from(Vec3d(9, 1.5, 2.5), Vec3d(-length, 0, 0)), TestType::name);
    REQUIRE(hit);
    CHECK(std::fabs(hit.t * length - 3.75) <= half_cell);
    CHECK(hit.t_outside <= hit.t);
    CHECK(hit.cell == Vec3i(5, 1, 2));
  }
}

TEST_CASE("zero, infinite and NaN rays miss") {
  const LevelSet level_set(wall());
  const Vec3d o(9, 1.5, 2.5), d(-1, 0, 0);
  CHECK(closest_hit(level_set, ray_from(o, d)));
  CHECK_FALSE(closest_hit(level_set, ray_from(o, Vec3d(0, 0, 0))));
  CHECK_FALSE(closest_hit(level_set, ray_from(o, Vec3d(-0.0, 0, -0.0))));
  CHECK_FALSE(closest_hit(level_set, ray_from(o, Vec3d(-5e-324, 0, 0)))); // t would overflow
  for (int a = 0; a < 3; ++a) {
    for (const double bad : {nan_value, inf, -inf}) {
      Vec3d p = o, q = d;
      p[a] = bad, q[a] = bad;
      CHECK_FALSE(closest_hit(level_set, ray_from(p, d)));
      CHECK_FALSE(closest_hit(level_set, ray_from(o, q)));
      CHECK_FALSE(any_hit(level_set, ray_from(o, q)));
    }
  }
  CHECK_FALSE(closest_hit(level_set, ray_from(o, d, nan_value, inf)));
  CHECK_FALSE(closest_hit(level_set, ray_from(o, d, 0, nan_value)));
  CHECK_FALSE(closest_hit(level_set, ray_from(o, d, 5, 4)));
  CHECK_FALSE(closest_hit(level_set, ray_from(o, d, inf, inf)));
  CHECK_FALSE(closest_hit(level_set, ray_from(o, d, -inf, -inf)));
}

TEST_CASE("components of zero, minus zero and denormals change nothing") {
  const LevelSet level_set(wall());
  for (const double y : {0.0, -0.0, 1e-40, -1e-40, 5e-324, 1e-30, -1e-30})
    for (const double z : {0.0, -0.0, 5e-324, -1e-200}) {
      // In the middle of cells, in a face plane, and along an edge of the lattice; at its lower and upper
      // side.
      for (const Vec3d& o :
           {Vec3d(9, 1.5, 2.5), Vec3d(9, 1, 2.5), Vec3d(9, 4, 4), Vec3d(9, 0, 0), Vec3d(9, 16, 16)}) {
        CAPTURE(y, z, o);
        const Hit hit = closest_hit(level_set, ray_from(o, Vec3d(-1, y, z)));
        REQUIRE(hit);
        CHECK(std::fabs(hit.t - 3.75) <= 0x1p-40);
      }
    }
}

TEST_CASE("intervals are closed, and may begin before 0 or have no end") {
  const LevelSet level_set(wall());
  const Vec3d o(9, 1.5, 2.5), d(-1, 0, 0);
  CHECK(closest_hit(level_set, ray_from(o, d, -inf, inf)).t == 3.75);
  CHECK(closest_hit(level_set, ray_from(o, d, -1e300, DBL_MAX)));
  CHECK(closest_hit(level_set, ray_from(o, d, 0, 3.75)));
  CHECK_FALSE(closest_hit(level_set, ray_from(o, d, 0, 3.7499999)));
  CHECK(closest_hit(level_set, ray_from(o, d, 3.75, 3.75)));
  CHECK_FALSE(closest_hit(level_set, ray_from(o, d, 2, 2)));
  CHECK(closest_hit(level_set, ray_from(Vec3d(0, 1.5, 2.5), d, -20, 0)).t == -5.25);
  // Begun beyond the surface, the ray is inside and comes out at the far end of the box, behind sample -21.
  const Hit out = closest_hit(level_set, ray_from(o, d, 4, inf));
  REQUIRE(out);
  CHECK(out.from_inside);
  CHECK(out.t > 9 + 20);
  CHECK(out.t < 9 + 21);
}

TEST_CASE("origins up to 10^12 voxels away hit") {
  const LevelSet level_set(wall());
  for (const double distance : {1e3, 1e6, 1e9, 1e12}) {
    CAPTURE(distance);
    const Hit hit = closest_hit(level_set, ray_from(Vec3d(5.25 + distance, 1.5, 2.5), Vec3d(-1, 0, 0)));
    REQUIRE(hit);
    CHECK(std::fabs(hit.t - distance) <= 0x1p-40 + distance * 0x1p-51);
    // Slanted, towards a point of the surface: the place is as good as coordinates of that size.
    const Vec3d target(5.25, 1.5, 2.5), d = Vec3d(-0.8, 0.36, 0.48);
    const Hit slanted = closest_hit(level_set, ray_from(target - d * distance, d));
    REQUIRE(slanted);
    CHECK(std::fabs(slanted.t - distance) <= 0x1p-40 + distance * 0x1p-49);
  }
}

TEST_CASE("origins on samples, edges and faces and one ulp beside them hit") {
  const LevelSet level_set(wall());
  for (const double x : {6.0, 7.0, 8.0, 16.0})
    for (const double y : {0.0, 1.0, 4.0, 0.5})
      for (const int ulp : {-1, 0, 1}) {
        const double start = ulp < 0 ? std::nextafter(x, -inf) : ulp > 0 ? std::nextafter(x, inf) : x;
        const double side = ulp < 0 ? std::nextafter(y, -inf) : ulp > 0 ? std::nextafter(y, inf) : y;
        const Hit hit = closest_hit(level_set, ray_from(Vec3d(start, side, 3), Vec3d(-1, 0, 0)));
        REQUIRE(hit);
        CHECK(std::fabs(hit.t - (start - 5.25)) <= 0x1p-40);
        CHECK_FALSE(hit.from_inside);
      }
}

TEST_CASE("a ray that begins on the surface is hit there") {
  const LevelSet level_set(wall());
  for (const Vec3d& d : {Vec3d(-1, 0, 0), Vec3d(1, 0, 0), Vec3d(0, 1, 0), Vec3d(0.6, 0.8, 0)}) {
    const Hit hit = closest_hit(level_set, ray_from(Vec3d(5.25, 1.5, 2.5), d));
    REQUIRE(hit);
    CHECK(hit.t == 0);
  }
}

TEST_CASE("a ray within a surface that fills a face plane hits where the plane begins") {
  // f = x - 5: the surface is the samples' own plane.
  const BlockGrid grid = sample_grid([](const Vec3d& p) { return p.x - 5; }, 1, 3,
                                     Box3d(Vec3d(-20, -12, -9), Vec3d(12, 17, 20)));
  const LevelSet level_set(grid);
  const Hit hit = closest_hit(level_set, ray_from(Vec3d(5, -40, 2.5), Vec3d(0, 1, 0)));
  REQUIRE(hit);
  CHECK(hit.t >= 40 - 13);
  CHECK(hit.t <= 40 - 12);
  CHECK(closest_hit(level_set, ray_from(Vec3d(5, 0, 0), Vec3d(0, 1, 1))).t == 0);
}

TEST_CASE("rays through corners of blocks along all diagonals hit") {
  const BlockGrid grid = sphere_grid(20);
  const LevelSet level_set(grid);
  for (int x = -1; x <= 1; ++x)
    for (int y = -1; y <= 1; ++y)
      for (int z = -1; z <= 1; ++z) {
        if (!x && !y && !z) continue;
        const Vec3d d(x, y, z);
        const Hit hit = closest_hit(level_set, ray_from(Vec3d(0, 0, 0) - d * 64, d));
        REQUIRE(hit);
        const double radius = (Vec3d(0, 0, 0) - d * 64 + d * hit.t - Vec3d(-2.3, 1.7, 0.4)).length();
        CHECK(std::fabs(radius - 20) < 1. / 80); // h^2 / 4R, the interpolation error of a sphere
      }
}

TEST_CASE("a single cell, a full block and huge or tiny voxels can be traced") {
  for (const double voxel : {1e-9, 1.0, 1e9}) {
    for (const double radius : {0.3, 0.6, 2.0, 7.0}) {
      const BlockGrid grid = sample_grid(sphere_field(Vec3d(0, 0, 0), radius * voxel), voxel, 3,
                                         Box3d(Vec3d(-12, -12, -12) * voxel, Vec3d(12, 13, 14) * voxel));
      const LevelSet level_set(grid);
      for (const Vec3d& d : {Vec3d(1, 0, 0), Vec3d(0, -1, 0), Vec3d(0, 0, 1)}) {
        const Hit hit = closest_hit(level_set, ray_from(-d * (20 * voxel), d));
        REQUIRE(hit);
        CHECK(std::fabs(hit.t / voxel - (20 - radius)) <= 1e-6); // linear along axes through samples; floats
      }
    }
  }
}

TEST_CASE("an unknown intersector is refused with the legal names") {
  const LevelSet level_set(wall());
  CHECK_THROWS_WITH(closest_hit(level_set, WorldRay{}, "bisection"),
                    Catch::Contains("bisection") && Catch::Contains("exact") && Catch::Contains("midpoint"));
  CHECK(closest_hit(level_set, ray_from(Vec3d(9, 1.5, 2.5), Vec3d(-1, 0, 0)), "false-position").t == 3.75);
}

TEST_CASE("counts grow with the work and any_hit does no more of it") {
  const BlockGrid grid = sphere_grid(20);
  const LevelSet level_set(grid);
  RandomRays random(2);
  for (int i = 0; i < 1000; ++i) {
    const WorldRay ray = random.through(active_box(grid));
    const Hit hit = closest_hit(level_set, ray);
    RayCounts any;
    any_hit(level_set, ray, "exact", &any);
    CHECK(any.steps == hit.counts.steps);
    CHECK(any.tests == hit.counts.tests);
    if (hit) CHECK(hit.counts.tests > 0);
    CHECK(hit.counts.steps < 200);
  }
}
