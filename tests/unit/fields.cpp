// Analytic fields against brute force: points of the surface, steps that cannot pass it, differences.
#include "levelray/convert/field_to_grid.hpp"
#include "levelray/field/reference_shapes.hpp"
#include "levelray/measure/reference.hpp"
#include "support/catch.hpp"
#include "support/trace_fixtures.hpp"

#include <vector>

using namespace levelray;
using namespace levelray::test;

namespace {

Box3d grown(const Box3d& box, double by) {
  return Box3d(box.min - Vec3d(by, by, by), box.max + Vec3d(by, by, by));
}

// Where random rays enter and leave the shape.
template <class Shape>
std::vector<Vec3d> surface_points(const Shape& shape, int rays, RandomRays& random) {
  std::vector<Vec3d> points;
  for (int i = 0; i < rays; ++i) {
    const WorldRay ray = random.through(shape.bounds());
    if (const Chord chord = shape.chord(ray)) {
      points.push_back(ray.at(chord.enter));
      points.push_back(ray.at(chord.exit));
    }
  }
  return points;
}

double trilinear(const Reference& shape, const Vec3d& p, double h) {
  double sum = 0;
  const Vec3d cell(std::floor(p.x / h), std::floor(p.y / h), std::floor(p.z / h));
  for (int c = 0; c < 8; ++c) {
    const Vec3d corner = cell + Vec3d(c & 1, c >> 1 & 1, c >> 2);
    double weight = 1;
    for (int a = 0; a < 3; ++a) weight *= 1 - std::fabs(p[a] / h - corner[a]);
    sum += weight * static_cast<double>(static_cast<float>(shape.value(corner * h)));
  }
  return sum;
}

} // namespace

TEMPLATE_LIST_TEST_CASE("a field is the distance to the nearest point of its surface", "", ReferenceShapes) {
  const TestType shape;
  CAPTURE(TestType::name);
  INFO("seed 11");
  RandomRays random(11);
  const std::vector<Vec3d> surface = surface_points(shape, 6000, random);
  REQUIRE(surface.size() > 500);
  for (const Vec3d& p : surface) CHECK(std::fabs(shape.value(p)) < 1e-12);

  for (int i = 0; i < 300; ++i) {
    const Vec3d p = random.in_box(grown(shape.bounds(), 0.2));
    const double value = shape.value(p);
    double nearest = kinked;
    for (const Vec3d& q : surface) nearest = std::min(nearest, (p - q).length());
    CHECK(nearest >= std::fabs(value) - 1e-12); // no point of the surface is nearer
    if (!TestType::is_distance) continue;
    const Vec3d foot = p - shape.gradient(p) * value; // and one is there
    CHECK(std::fabs(shape.value(foot)) < 1e-12);
  }
}

TEMPLATE_LIST_TEST_CASE("a field changes by no more than the way, and its gradient tells how", "",
                        ReferenceShapes) {
  const TestType shape;
  CAPTURE(TestType::name);
  INFO("seed 12");
  RandomRays random(12);
  const Box3d box = grown(shape.bounds(), 0.1);
  constexpr double step = 1e-5;
  int smooth = 0;
  for (int i = 0; i < 3000; ++i) {
    const Vec3d p = random.in_box(box), q = random.in_box(box);
    CHECK(std::fabs(shape.value(p) - shape.value(q)) <= (p - q).length() * (1 + 1e-14));
    const Vec3d gradient = shape.gradient(p);
    CHECK(std::fabs(gradient.length() - 1) < 1e-14);

    const double bend = shape.curvature(p, 2 * step);
    if (!(bend < 100)) continue;
    ++smooth;
    Vec3d slope;
    double bends = 0;
    for (int a = 0; a < 3; ++a) {
      Vec3d e(0, 0, 0);
      e[a] = step;
      const double forward = shape.value(p + e), back = shape.value(p - e);
      slope[a] = (forward - back) / (2 * step);
      bends += std::fabs(forward + back - 2 * shape.value(p)) / (step * step);
    }
    // Central differences are off by half a step times the second derivatives at the most, and by the
    // rounding of values below 1, 2^-52, over the step; second differences by 4 * 2^-52 over its square,
    // along 3 axes.
    const double length = slope.length();
    if (TestType::is_distance) CHECK(std::fabs(length - 1) < bend * step + 1e-10);
    CHECK((slope / length - gradient).length() < 2 * (bend * step + 1e-10) / length);
    CHECK(bends <= bend * (1 + 1e-3) + 12 * 0x1p-52 / (step * step));
  }
  CHECK(smooth > 500);
}

// Steps by the field's value cannot pass the surface, because the field is 1-Lipschitz; where it is below
// 1e-8 they are 1e-8, which passes that deep at the most.
TEMPLATE_LIST_TEST_CASE("a chord begins where careful steps first meet the surface", "", ReferenceShapes) {
  const TestType shape;
  CAPTURE(TestType::name);
  INFO("seed 13");
  RandomRays random(13);
  constexpr double least = 1e-8;
  int hits = 0, misses = 0, undecided = 0;
  for (int i = 0; i < 3000; ++i) {
    WorldRay ray = random.through(grown(shape.bounds(), 0.1));
    ray.direction = ray.direction * random.uniform(0.2, 5); // t is in units of the direction's length
    const double speed = ray.direction.length();
    const Chord chord = shape.chord(ray);
    undecided += chord.kind == Chord::Kind::undecided;
    if (chord.kind == Chord::Kind::undecided) continue;
    ++(chord ? hits : misses);
    const double end = chord ? chord.enter : 8 / speed;
    double t = 0, value = 1;
    bool clear = true;
    for (;;) {
      value = shape.value(ray.at(t));
      const double next = t + std::max(value, least) / speed;
      if (next >= end) break;
      clear = clear && value > (chord ? 0 : -least);
      t = next;
    }
    CHECK(clear); // nothing before the entry
    if (!chord) continue;
    CHECK((end - t) * speed <= std::max(value, least)); // and the last step leads there
    CHECK(chord.error * speed < 1e-12);
    CHECK(std::fabs(shape.value(ray.at(chord.exit))) < 1e-12);
    // Inside between the two ends, none of which is a touch.
    for (int k = 1; k < 16; ++k)
      CHECK(shape.value(ray.at(chord.enter + (chord.exit - chord.enter) * k / 16)) < 0);
  }
  CHECK(hits > 100);
  CHECK(misses > 100);
  CHECK(undecided < 3);
}

TEMPLATE_LIST_TEST_CASE("a chord knows of beginnings and ends of rays", "", ReferenceShapes) {
  const TestType shape;
  CAPTURE(TestType::name);
  INFO("seed 14");
  RandomRays random(14);
  int inside = 0;
  for (int i = 0; i < 400; ++i) {
    WorldRay ray = random.through(shape.bounds());
    const Chord whole = shape.chord(ray);
    if (!whole) continue;
    ++inside;
    ray.t_min = (whole.enter + whole.exit) / 2;
    const Chord half = shape.chord(ray);
    REQUIRE(half);
    CHECK(half.enter == ray.t_min);
    CHECK(half.error == 0);
    // Roots searched for anew from another place differ by roundings.
    CHECK(half.exit == Approx(whole.exit).margin(1e-12));
    ray.t_min = 0;
    ray.t_max = whole.enter - 1e-6;
    CHECK_FALSE(shape.chord(ray));
  }
  CHECK(inside > 20);
}

TEST_CASE("a ray in a shell's hollow first enters the far wall") {
  const shapes::HollowBall shell;
  WorldRay ray;
  ray.origin = shell.centre;
  ray.direction = Vec3d(0.6, 0, 0.8);
  const Chord chord = shell.chord(ray);
  REQUIRE(chord);
  CHECK(chord.enter == Approx(shell.radius - shell.thickness / 2).margin(1e-14));
  CHECK(chord.exit == Approx(shell.radius + shell.thickness / 2).margin(1e-14));
}

TEST_CASE("interpolation is off by no more than its bound, on smooth parts and on kinks") {
  INFO("seed 15");
  RandomRays random(15);
  for (const Reference& shape : all_references()) {
    CAPTURE(shape.name);
    int tight = 0;
    for (int i = 0; i < 4000; ++i) {
      const double h = 1 / random.uniform(20, 200);
      Vec3d p = random.in_box(grown(shape.bounds, 3 * h));
      p -= shape.gradient(p) * (shape.value(p) + random.uniform(-h, h)); // near the surface
      if (!(std::fabs(shape.value(p)) < 2 * h)) continue;
      const double bound = interpolation_error(shape, p, h, 3 * h);
      // 3 h is more than any corner's value is from 0, so its rounding is within the bound's.
      const double error = std::fabs(trilinear(shape, p, h) - shape.value(p));
      CHECK(error <= bound + 1e-15);
      tight += error > bound / 4;
    }
    if (shape.name != "box") CHECK(tight > 0); // the bound is of the errors' size
  }
}

TEMPLATE_LIST_TEST_CASE("a sampled field has the blocks and bits of brute force", "", ReferenceShapes) {
  const TestType shape;
  CAPTURE(TestType::name);
  for (const double half_width : {1.0, 3.0}) {
    FieldSampling sampling;
    sampling.voxel_size = 1.0 / 24;
    sampling.half_width_voxels = half_width;
    sampling.origin = Vec3d(0.3, -0.1, 0.07);
    const BlockGrid grid = field_to_grid(shape, sampling, shape.bounds());
    const Box3d box = grown(shape.bounds(), 5 * sampling.voxel_size);
    const BlockGrid brute = sample_grid([&](const Vec3d& p) { return shape.value(p); }, sampling.voxel_size,
                                        half_width, box, sampling.origin);
    CHECK(grid.background == brute.background);
    CHECK(grid.active_sample_count() == brute.active_sample_count());
    CHECK(grid.active_bounds() == brute.active_bounds());
    std::uint64_t different = 0, cells = 0, brute_cells = 0;
    const Vec3i low = brute.node_min * node_dim, high = low + brute.node_dims * node_dim;
    for (int k = low.z; k < high.z; ++k)
      for (int j = low.y; j < high.y; ++j)
        for (int i = low.x; i < high.x; ++i) different += grid.value(i, j, k) != brute.value(i, j, k);
    CHECK(different == 0);
    for (const std::uint64_t mask : grid.cells) cells += static_cast<std::uint64_t>(std::popcount(mask));
    for (const std::uint64_t mask : brute.cells)
      brute_cells += static_cast<std::uint64_t>(std::popcount(mask));
    CHECK(cells == brute_cells);
  }
}

TEST_CASE("a sampled field is the same for any number of threads, and refuses too much memory") {
  FieldSampling sampling;
  sampling.voxel_size = 1.0 / 64;
  const shapes::FatTorus torus;
  const BlockGrid all = field_to_grid(torus, sampling, torus.bounds());
  const ThreadLimit one(1);
  const BlockGrid single = field_to_grid(torus, sampling, torus.bounds());
  CHECK(all.values == single.values);
  CHECK(all.active == single.active);
  CHECK(all.node_table == single.node_table);
  sampling.max_bytes = 100'000;
  CHECK_THROWS_WITH(field_to_grid(torus, sampling, torus.bounds()),
                    Catch::Contains("more memory than allowed"));
  sampling.max_bytes = std::numeric_limits<std::uint64_t>::max();
  sampling.voxel_size = 1e-12;
  CHECK_THROWS_WITH(field_to_grid(torus, sampling, torus.bounds()), Catch::Contains("larger voxels"));
}
