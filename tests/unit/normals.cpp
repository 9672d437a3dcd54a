#include "levelray/normal/normals.hpp"
#include "levelray/normal/neighbourhood.hpp"
#include "levelray/trace/level_set.hpp"
#include "support/catch.hpp"
#include "support/trace_fixtures.hpp"

using namespace levelray;
using namespace levelray::test;

namespace {

double degrees_between(const Vec3d& a, const Vec3d& b) {
  return std::atan2(a.cross(b).length(), a.dot(b)) * 180 / 3.14159265358979323846;
}

} // namespace

TEMPLATE_LIST_TEST_CASE("a scheme gives a plane's normal exactly", "", NormalSchemes) {
  CHECK_FALSE(TestType::name.empty());
  const Vec3d n = Vec3d(0.48, -0.6, 0.64);
  const BlockGrid grid = sample_grid([&](const Vec3d& p) { return p.dot(n) + 0.37; }, 1, 8,
                                     Box3d(Vec3d(-13, -9, -11), Vec3d(12, 14, 19)));
  RandomRays random(3);
  for (int i = 0; i < 200; ++i) {
    // Cells whose neighbourhood is clear of the clamped band and the border.
    Vec3d p = random.in_box(Box3d(Vec3d(-7, -4, -5), Vec3d(7, 8, 11)));
    p -= n * (p.dot(n) + 0.37);
    CellPosition at;
    for (int a = 0; a < 3; ++a)
      at.cell[a] = static_cast<int>(std::floor(p[a])), at.local[a] = p[a] - at.cell[a];
    // Samples are rounded to float: 2^-24 of values below 8, differences over a voxel, in 3 components.
    CHECK((unit_normal<TestType>(Neighbourhood(grid, at.cell), at) - n).length() < 8 * 0x1p-24 * 4);
  }
}

TEMPLATE_LIST_TEST_CASE("a scheme's normals on a sphere are as good as it can be", "", NormalSchemes) {
  const Vec3d centre(-2.3, 1.7, 0.4);
  const BlockGrid grid = sphere_grid(20);
  const LevelSet level_set(grid);
  RandomRays random(5);
  double worst = 0, sum = 0;
  int hits = 0;
  for (int i = 0; i < 4000; ++i) {
    const WorldRay ray = random.through(active_box(grid));
    const Hit hit = closest_hit(level_set, ray);
    if (!hit) continue;
    const Vec3d normal(hit_normal(level_set, ray, hit, TestType::name));
    CHECK(std::fabs(normal.length() - 1) < 1e-6);
    const double angle = degrees_between(normal, ray.at(hit.t) - centre);
    worst = std::max(worst, angle);
    sum += angle;
    ++hits;
  }
  // Curvature 1/20 per voxel turns the normal by 2.9 degrees per voxel. The analytic gradient is piecewise,
  // off by up to half a cell's diagonal of that (methods study: mean 0.89, max 2.0), and so is a one-sided
  // difference over half a voxel; symmetric schemes are off by third derivatives only, 1/20^2 rad = 0.14
  // degrees over small factors (means 0.014 and 0.007, maxima 0.03).
  const bool smooth = TestType::name != "analytic" && TestType::name != "difference-of-interpolations";
  CAPTURE(TestType::name, worst, sum / hits, hits);
  CHECK(worst < (smooth ? 0.14 : 2.5));
  CHECK(sum / hits < (smooth ? 0.05 : 1.3));
}

TEMPLATE_LIST_TEST_CASE("smooth schemes do not jump between cells", "", NormalSchemes) {
  const BlockGrid grid = torus_grid(12, 2.5);
  RandomRays random(9);
  const Box3i box = grid.active_bounds();
  for (int i = 0; i < 2000; ++i) {
    CellPosition low;
    for (int a = 0; a < 3; ++a) {
      low.cell[a] = static_cast<int>(random.uniform(box.min[a], box.max[a]));
      low.local[a] = random.uniform(0, 1);
    }
    const int axis = i % 3;
    low.local[axis] = 1;
    CellPosition high = low;
    high.cell[axis] += 1;
    high.local[axis] = 0;
    if (TestType::name == "analytic" || TestType::name == "sharp-features") { // which may jump
      CHECK(unit_normal<TestType>(Neighbourhood(grid, low.cell), low).length() == Approx(1));
      continue;
    }
    const Vec3d a = TestType::gradient(Neighbourhood(grid, low.cell), low),
                b = TestType::gradient(Neighbourhood(grid, high.cell), high);
    CHECK((a - b).length() < 1e-5); // float sums of values below 3
  }
}

TEMPLATE_LIST_TEST_CASE("where all samples are equal a normal is still of unit length", "", NormalSchemes) {
  BlockGrid grid;
  grid.background = 2;
  const Vec3d normal = unit_normal<TestType>(Neighbourhood(grid, Vec3i(0, 0, 0)), CellPosition{});
  CHECK(normal == Vec3d(0, 0, 1));
}

TEMPLATE_LIST_TEST_CASE("extreme units do not matter to normals", "", NormalSchemes) {
  for (const double voxel : {1e-9, 1e9}) {
    const BlockGrid grid = sphere_grid(6, 3, voxel);
    const LevelSet level_set(grid);
    WorldRay ray;
    ray.origin = Vec3d(-2.3, 1.7, 40) * voxel;
    ray.direction = Vec3d(0, 0, -1);
    const Hit hit = closest_hit(level_set, ray);
    REQUIRE(hit);
    CHECK(degrees_between(Vec3d(hit_normal(level_set, ray, hit, TestType::name)), Vec3d(0, 0, 1)) < 8);
  }
}

TEST_CASE("offset differences are those of the interpolant half a voxel to either side") {
  RandomRays random(12);
  Neighbourhood f;
  for (int n = 0; n < 500; ++n) {
    for (int k = -1; k < 3; ++k)
      for (int j = -1; j < 3; ++j)
        for (int i = -1; i < 3; ++i) f.at(i, j, k) = static_cast<float>(random.uniform(-1, 1));
    CellPosition at;
    for (double& x : at.local)
      x = n % 10 ? random.uniform(0, 1) : 0.5 * (n / 10 % 3); // faces and middles too
    const auto interpolant = [&](const Vec3d& p) {
      double sum = 0;
      for (int c = 0; c < 8; ++c) {
        double weight = 1;
        int index[3];
        for (int a = 0; a < 3; ++a) {
          const int base = p[a] < 0 ? -1 : p[a] >= 1 ? 1 : 0;
          index[a] = base + (c >> a & 1);
          weight *= c >> a & 1 ? p[a] - base : 1 - (p[a] - base);
        }
        sum += weight * double(f.at(index[0], index[1], index[2]));
      }
      return sum;
    };
    const Vec3d p(at.local[0], at.local[1], at.local[2]);
    Vec3d expected;
    for (int a = 0; a < 3; ++a) {
      Vec3d half(0, 0, 0);
      half[a] = 0.5;
      expected[a] = interpolant(p + half) - interpolant(p - half);
    }
    // Twelve products of floats below 2, each rounded a few times.
    REQUIRE((OffsetDifferences::gradient(f, at) - expected).length() < 12 * 4 * 0x1p-23);
  }
}

TEMPLATE_LIST_TEST_CASE("whatever the samples, a normal has unit length", "", NormalSchemes) {
  constexpr unsigned seed = 14;
  CAPTURE(seed);
  RandomRays random(seed);
  Neighbourhood f;
  for (int n = 0; n < 3000; ++n) {
    const double scale = std::pow(10, random.uniform(-8, 8));
    for (int k = -1; k < 3; ++k)
      for (int j = -1; j < 3; ++j)
        for (int i = -1; i < 3; ++i) {
          const double value = random.uniform(-1, 1);
          f.at(i, j, k) =
              static_cast<float>(n % 3 == 0   ? scale * value               // noise
                                 : n % 3 == 1 ? std::copysign(scale, value) // beyond the band on both sides
                                              : value * std::pow(10, random.uniform(-8, 8))); // of all sizes
        }
    CellPosition at;
    for (double& x : at.local) x = random.uniform(0, 1);
    REQUIRE(std::fabs(unit_normal<TestType>(f, at).length() - 1) < 1e-12);
  }
}

TEST_CASE("a neighbourhood is the samples around its cell") {
  const BlockGrid grid = sphere_grid(5);
  const Box3i box = grid.active_bounds();
  RandomRays random(6);
  for (int n = 0; n < 500; ++n) {
    Vec3i cell;
    for (int a = 0; a < 3; ++a)
      cell[a] = static_cast<int>(std::floor(random.uniform(box.min[a] - 6, box.max[a] + 6)));
    const Neighbourhood samples(grid, cell);
    for (int k = -1; k < 3; ++k)
      for (int j = -1; j < 3; ++j)
        for (int i = -1; i < 3; ++i)
          REQUIRE(samples.at(i, j, k) == grid.value(cell.x + i, cell.y + j, cell.z + k));
  }
}

TEMPLATE_LIST_TEST_CASE("the samples for normals are the same from the tracer's records and from the grid",
                        "", NormalSchemes) {
  // Cells at every place in their blocks, with and without surface blocks as neighbours.
  for (const BlockGrid& grid : {sphere_grid(7.3), torus_grid(10, 1)}) {
    const LevelSet level_set(grid);
    RandomRays random(7);
    int hits = 0, beyond_records = 0;
    for (int n = 0; n < 2000; ++n) {
      const WorldRay ray = random.through(active_box(grid));
      const Hit hit = closest_hit(level_set, ray);
      if (!hit) continue;
      ++hits;
      CellPosition at;
      at.cell = hit.cell;
      const Vec3d p = (ray.at(hit.t) - grid.transform.origin) * (1 / grid.transform.voxel_size);
      for (int a = 0; a < 3; ++a) {
        at.local[a] = std::min(std::max(p[a] - hit.cell[a], 0.0), 1.0);
        Vec3i next = hit.cell;
        next[a] += (hit.cell[a] & 3) == 0 ? -1 : (hit.cell[a] & 3) == 3 ? 2 : 0;
        beyond_records += !level_set.surface().find_record(next);
      }
      const Vec3f from_grid(unit_normal<TestType>(Neighbourhood(grid, hit.cell), at));
      REQUIRE(hit_normal(level_set, ray, hit, TestType::name) == from_grid);
    }
    CHECK(hits > 300);
    CHECK(beyond_records > 30);
  }
}

TEST_CASE("an unknown normal scheme is refused with the legal names") {
  const BlockGrid grid = sphere_grid(3);
  const LevelSet level_set(grid);
  CHECK_THROWS_WITH(hit_normal(level_set, WorldRay{}, Hit{}, "smooth"),
                    Catch::Contains("smooth") && Catch::Contains("analytic"));
}
