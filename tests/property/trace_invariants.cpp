// What must hold for every ray, whatever the shape: no leaks, any = closest, symmetries.
#include "levelray/intersect/intersectors.hpp"
#include "levelray/trace/level_set.hpp"
#include "support/catch.hpp"
#include "support/trace_fixtures.hpp"

#include <memory>

using namespace levelray;
using namespace levelray::test;

namespace {

std::vector<Shape> closed_shapes(const Vec3d& shift = Vec3d(0, 0, 0)) {
  return {{"sphere", sample_grid(sphere_field(Vec3d(-2.3, 1.7, 0.4) + shift, 9), 1, 3,
                                 Box3d(shift - Vec3d(15, 13, 14), shift + Vec3d(13, 14, 30)))},
          {"torus with a tube of radius 1", torus_grid(10, 1, shift)},
          {"plate 0.8 voxel thick", slab_grid(0.8, 12, shift)},
          {"gyroid", gyroid_grid(14, shift)}};
}

// A random point inside (f < 0), to start from.
Vec3d point_inside(const BlockGrid& grid, RandomRays& random) {
  const Box3i box = grid.active_bounds();
  for (;;) {
    Vec3i cell;
    for (int a = 0; a < 3; ++a)
      cell[a] = static_cast<int>(std::floor(random.uniform(box.min[a], box.max[a])));
    const Vec3d local(random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 1));
    double f = 0;
    for (int c = 0; c < 8; ++c)
      f += (c & 1 ? local.x : 1 - local.x) * (c & 2 ? local.y : 1 - local.y) *
           (c & 4 ? local.z : 1 - local.z) *
           double(grid.value(cell.x + (c & 1), cell.y + (c >> 1 & 1), cell.z + (c >> 2)));
    if (f < -1e-9) return grid.transform.to_world(Vec3d(cell) + local);
  }
}

// The grid with its samples moved to i' = sign_i * i of axis order[a], by way of a dense copy; the ray
// likewise.
struct Symmetry {
  int order[3];
  int sign[3];
};

BlockGrid transformed(const BlockGrid& grid, const Symmetry& symmetry) {
  const Box3i bounds = grid.active_bounds();
  Box3d box;
  for (const Vec3i& corner : {bounds.min - Vec3i(2, 2, 2), bounds.max + Vec3i(2, 2, 2)}) {
    Vec3d p;
    for (int a = 0; a < 3; ++a) p[a] = symmetry.sign[a] * corner[symmetry.order[a]];
    box.extendBy(p);
  }
  return sample_grid(
      [&](const Vec3d& p) {
        int source[3];
        for (int a = 0; a < 3; ++a)
          source[symmetry.order[a]] = symmetry.sign[a] * static_cast<int>(std::lround(p[a]));
        return double(grid.value(source[0], source[1], source[2]));
      },
      1, 3, box);
}

WorldRay transformed(const WorldRay& ray, const Symmetry& symmetry) {
  WorldRay result = ray;
  for (int a = 0; a < 3; ++a) {
    result.origin[a] = symmetry.sign[a] * ray.origin[symmetry.order[a]];
    result.direction[a] = symmetry.sign[a] * ray.direction[symmetry.order[a]];
  }
  return result;
}

} // namespace

TEST_CASE("no ray leaves a closed surface from inside unnoticed, near the origin or far from it") {
  // 2^20 voxels away coordinates have 2^-32 left; far points are as good, as the frame begins at the box.
  for (const Vec3d& shift : {Vec3d(0, 0, 0), Vec3d(1 << 20, -(1 << 20), 1 << 19)}) {
    for (const Shape& shape : closed_shapes(shift)) {
      const LevelSet level_set(shape.grid);
      RandomRays random(31);
      std::size_t leaks = 0, doubtful_side = 0;
      for (int i = 0; i < 20000; ++i) {
        WorldRay ray;
        ray.origin = point_inside(shape.grid, random);
        ray.direction = random.direction();
        if (i % 4 == 0) // along an axis or a diagonal
          ray.direction = Vec3d(i % 3 ? 1 : 0, i % 5 ? -1 : 0, i % 7 && (i % 3 == 0 || i % 5) ? 1 : 0);
        if (ray.direction == Vec3d(0, 0, 0)) ray.direction.y = 1;
        const Hit hit = closest_hit(level_set, ray);
        leaks += !hit;
        doubtful_side += hit && !hit.from_inside;
      }
      CAPTURE(shape.name, shift);
      CHECK(leaks == 0);
      CHECK(doubtful_side == 0);
    }
  }
}

TEMPLATE_LIST_TEST_CASE("any_hit finds a hit exactly when closest_hit does", "", Intersectors) {
  for (const Shape& shape : closed_shapes()) {
    const LevelSet level_set(shape.grid);
    RandomRays random(17);
    std::size_t differences = 0, hits = 0;
    for (int i = 0; i < 20000; ++i) {
      WorldRay ray = random.through(active_box(shape.grid));
      if (i % 3 == 0) ray.origin = random.in_box(active_box(shape.grid));
      if (i % 5 == 0) ray.t_max = random.uniform(0, 60);
      const bool closest = bool(closest_hit(level_set, ray, TestType::name));
      differences += closest != any_hit(level_set, ray, TestType::name);
      hits += closest;
    }
    CAPTURE(shape.name);
    CHECK(differences == 0);
    CHECK(hits > 500);
  }
}

TEMPLATE_LIST_TEST_CASE("a secondary ray from t_outside does not hit the surface it starts from", "",
                        Intersectors) {
  if (TestType::name == "midpoint") return; // hits every cell of the surface, the one it starts in too
  for (const Shape& shape : closed_shapes()) {
    const LevelSet level_set(shape.grid);
    RandomRays random(23);
    std::size_t began_inside = 0, hits = 0, backwards = 0;
    for (int i = 0; i < 20000; ++i) {
      const WorldRay ray = random.through(active_box(shape.grid));
      const Hit hit = closest_hit(level_set, ray, TestType::name);
      if (!hit) continue;
      ++hits;
      WorldRay secondary;
      secondary.origin = ray.at(hit.t_outside);
      secondary.direction = random.direction();
      began_inside += closest_hit(level_set, secondary, TestType::name).from_inside;
      // Straight back there is nothing but the way it came.
      secondary.direction = -ray.direction;
      backwards += any_hit(level_set, secondary, TestType::name);
    }
    CAPTURE(shape.name, hits);
    CHECK(began_inside == 0);
    CHECK(backwards == 0);
  }
}

TEST_CASE("mirroring the grid and the ray, or swapping their axes, gives the same t") {
  const Symmetry symmetries[] = {{{0, 1, 2}, {-1, 1, 1}}, {{0, 1, 2}, {1, -1, -1}}, {{0, 1, 2}, {-1, -1, -1}},
                                 {{1, 2, 0}, {1, 1, 1}},  {{2, 1, 0}, {1, 1, 1}},   {{2, 0, 1}, {-1, 1, -1}}};
  for (const Shape& shape : closed_shapes()) {
    const LevelSet level_set(shape.grid);
    for (const Symmetry& symmetry : symmetries) {
      const BlockGrid other_grid = transformed(shape.grid, symmetry);
      const LevelSet other(other_grid);
      const bool mirrored_only = symmetry.order[0] == 0 && symmetry.order[1] == 1;
      RandomRays random(41);
      std::size_t different = 0, hits = 0;
      for (int i = 0; i < 2000; ++i) {
        const WorldRay ray = random.through(active_box(shape.grid));
        const Hit a = closest_hit(level_set, ray), b = closest_hit(other, transformed(ray, symmetry));
        hits += bool(a);
        // Nodes begin at samples 16 k, so the box is not mirrored onto itself and the ray is taken up up to
        // 16 voxels earlier or later; interpolation takes the axes in another order. Both change last bits:
        // of coordinates below 2^9, 2^-44. A graze magnifies that to its root times that of twice the radius
        // of curvature, below 24 voxels.
        different += bool(a) != bool(b) || std::fabs(a.t - b.t) > 1e-6;
      }
      CAPTURE(shape.name, mirrored_only, hits);
      CHECK(different == 0);
      CHECK(hits > 50);
    }
  }
}

TEST_CASE("scaling the world by a power of two scales t and nothing else") {
  for (const Shape& shape : closed_shapes()) {
    for (const double scale : {0x1p-30, 0x1p17}) {
      BlockGrid scaled = shape.grid;
      scaled.transform.voxel_size *= scale;
      scaled.background *= static_cast<float>(scale);
      for (float& value : scaled.values) value *= static_cast<float>(scale);
      const LevelSet a(shape.grid), b(scaled);
      RandomRays random(43);
      std::size_t different = 0;
      for (int i = 0; i < 3000; ++i) {
        const WorldRay ray = random.through(active_box(shape.grid));
        WorldRay far = ray;
        far.origin *= scale; // the direction stays of unit length: t scales
        const Hit x = closest_hit(a, ray), y = closest_hit(b, far);
        different += bool(x) != bool(y) || x.t * scale != y.t || x.t_outside * scale != y.t_outside ||
                     x.cell != y.cell;
        WorldRay longer = ray;
        longer.direction *= scale;
        const Hit z = closest_hit(a, longer);
        different += bool(x) != bool(z) || x.t / scale != z.t || x.cell != z.cell;
      }
      CAPTURE(shape.name, scale);
      CHECK(different == 0);
    }
  }
}

TEST_CASE("moving the grid by whole samples moves the hits and nothing else") {
  const std::vector<Shape> here = closed_shapes(), there = closed_shapes(Vec3d(1024, -512, 256));
  for (std::size_t s = 0; s < here.size(); ++s) {
    const LevelSet a(here[s].grid), b(there[s].grid);
    RandomRays random(47);
    std::size_t different = 0;
    for (int i = 0; i < 2000; ++i) {
      const WorldRay ray = random.through(active_box(here[s].grid));
      WorldRay moved = ray;
      moved.origin += Vec3d(1024, -512, 256);
      const Hit x = closest_hit(a, ray), y = closest_hit(b, moved);
      // Samples differ by the rounding of made-up fields so far out, 2^-24 of 3; a graze magnifies that to
      // its root.
      different += x && y && std::fabs(x.t - y.t) > 5e-3;
    }
    CAPTURE(here[s].name);
    CHECK(different == 0);
  }
}

TEST_CASE("rays traced in batches, past empty space in turns, answer as rays do alone") {
  for (const Shape& shape : closed_shapes()) {
    INFO(shape.name);
    const LevelSet level_set(shape.grid);
    RandomRays random(29);
    std::vector<WorldRay> rays;
    for (int n = 0; n < 1000; ++n) { // no multiple of a batch
      rays.push_back(random.through(active_box(shape.grid)));
      if (n % 5 == 0) rays.back().t_max = random.uniform(0, 60);
      if (n % 7 == 0) rays.back().origin = point_inside(shape.grid, random);
      if (n % 11 == 0) rays.back().direction = Vec3d(0, 0, 0);
    }
    std::vector<Hit> hits(rays.size());
    closest_hits(level_set, rays, "exact", hits);
    const auto any = std::make_unique<bool[]>(rays.size());
    RayCounts batch_counts, counts;
    any_hits(level_set, rays, "exact", {any.get(), rays.size()}, &batch_counts);
    int missed = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      CAPTURE(i);
      const Hit alone = trace_closest<Exact>(level_set, rays[i]); // walks the empty space itself
      missed += !alone;
      REQUIRE(hits[i].status == alone.status);
      REQUIRE(hits[i].from_inside == alone.from_inside);
      REQUIRE(hits[i].t == alone.t);
      REQUIRE(hits[i].t_outside == alone.t_outside);
      REQUIRE(hits[i].cell == alone.cell);
      REQUIRE(hits[i].counts.steps == alone.counts.steps);
      REQUIRE(hits[i].counts.tests == alone.counts.tests);
      REQUIRE(any[i] == trace_any<Exact>(level_set, rays[i], counts));
    }
    CHECK(missed > 100);
    CHECK(batch_counts.steps == counts.steps);
    CHECK(batch_counts.tests == counts.tests);
  }
}
