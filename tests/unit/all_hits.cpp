// All places of a ray: their order, kinds and sides where they are known by hand.
#include "levelray/trace/all_hits.hpp"
#include "levelray/trace/level_set.hpp"
#include "support/catch.hpp"
#include "support/trace_fixtures.hpp"

using namespace levelray;
using namespace levelray::test;

namespace {

// f = |x| - 2 and the like are exact at samples: planes x = 2 and x = -2, cut off by a box.
BlockGrid plate() {
  return sample_grid(
      [](const Vec3d& p) {
        return std::max({std::fabs(p.x) - 2, std::fabs(p.y) - 12, std::fabs(p.z) - 12});
      },
      1, 3, Box3d(Vec3d(-9, -18, -17), Vec3d(8, 17, 18)));
}

WorldRay along_x(double from, double to) {
  WorldRay ray;
  ray.origin = Vec3d(from, 0.25, 0.5);
  ray.direction = Vec3d(from < to ? 1 : -1, 0, 0);
  ray.t_max = std::fabs(to - from);
  return ray;
}

} // namespace

TEST_CASE("a ray through a plate enters it and leaves it") {
  const BlockGrid grid = plate();
  const LevelSet level_set(grid);
  std::vector<SurfacePlace> places;
  const EndSides sides = all_hits(level_set, along_x(-20, 20), places);
  REQUIRE(places.size() == 2);
  CHECK(places[0].kind == PlaceKind::enters);
  CHECK(places[0].t == 18);
  CHECK(places[1].kind == PlaceKind::leaves);
  CHECK(places[1].t == 22);
  CHECK(sides.first == 1);
  CHECK(sides.last == 1);
  CHECK(farthest_hit(level_set, along_x(-20, 20))->t == 22);
  CHECK(farthest_hit(level_set, along_x(20, -20))->kind == PlaceKind::leaves);
}

TEST_CASE("a ray that ends inside has one crossing, and one inside has none") {
  const BlockGrid grid = plate();
  const LevelSet level_set(grid);
  std::vector<SurfacePlace> places;
  EndSides sides = all_hits(level_set, along_x(-20, 0.5), places);
  CHECK(places.size() == 1);
  CHECK(sides.last == -1);
  sides = all_hits(level_set, along_x(-0.5, 0.5), places);
  CHECK(places.empty());
  CHECK(sides.first == -1);
  CHECK(sides.last == -1);
  CHECK_FALSE(farthest_hit(level_set, along_x(-0.5, 0.5)));
}

TEST_CASE("an interval that ends or begins on the surface touches it there") {
  const BlockGrid grid = plate();
  const LevelSet level_set(grid);
  std::vector<SurfacePlace> places;
  EndSides sides = all_hits(level_set, along_x(-20, -2), places);
  REQUIRE(places.size() == 1);
  CHECK(places[0].kind == PlaceKind::touch);
  CHECK(places[0].t == 18);
  CHECK(sides.first == 1);
  CHECK(sides.last == 0);
  sides = all_hits(level_set, along_x(2, 20), places); // away from it
  REQUIRE(places.size() == 1);
  CHECK(places[0].kind == PlaceKind::touch);
  CHECK(places[0].t == 0);
  CHECK(sides.first == 1);
  sides = all_hits(level_set, along_x(2, -20), places); // into it, and out again
  REQUIRE(places.size() == 2);
  CHECK(places[0].kind == PlaceKind::touch);
  CHECK(places[1].kind == PlaceKind::leaves);
  CHECK(sides.first == -1);
}

TEST_CASE("a ray along the surface touches it where it comes to it") {
  const BlockGrid grid = plate();
  const LevelSet level_set(grid);
  WorldRay ray;
  ray.origin = Vec3d(2, -30, 0.5);
  ray.direction = Vec3d(0, 1, 0);
  std::vector<SurfacePlace> places;
  const EndSides sides = all_hits(level_set, ray, places);
  REQUIRE(places.size() == 1);
  CHECK(places[0].kind == PlaceKind::touch);
  CHECK(places[0].t == 18);
  CHECK(sides.last == 1);
}

TEST_CASE("rays that are none have no places") {
  const BlockGrid grid = plate();
  const LevelSet level_set(grid);
  std::vector<SurfacePlace> places(3);
  WorldRay ray = along_x(-20, 20);
  ray.direction = Vec3d(0, 0, 0);
  CHECK(all_hits(level_set, ray, places).first == 1);
  CHECK(places.empty());
  ray = along_x(-20, 20);
  ray.t_max = -1;
  all_hits(level_set, ray, places);
  CHECK(places.empty());
  ray = along_x(-20, 20);
  ray.origin.y = std::numeric_limits<double>::quiet_NaN();
  all_hits(level_set, ray, places);
  CHECK(places.empty());
}

TEST_CASE("the first place is closest_hit's, bit for bit, and crossings alternate to the last side") {
  const Shape shapes[] = {
      {"torus", torus_grid(10, 1)}, {"plate", slab_grid(0.8, 12)}, {"gyroid", gyroid_grid(14)}};
  for (const Shape& shape : shapes) {
    const LevelSet level_set(shape.grid);
    RandomRays random(101);
    std::vector<SurfacePlace> places;
    std::size_t different = 0, odd_ones_out = 0, hits = 0, several = 0;
    for (int i = 0; i < 20000; ++i) {
      WorldRay ray = random.through(active_box(shape.grid));
      if (i % 3 == 0) ray.origin = random.in_box(active_box(shape.grid));
      if (i % 5 == 0) ray.t_max = random.uniform(0, 60);
      const Hit hit = closest_hit(level_set, ray);
      const EndSides sides = all_hits(level_set, ray, places);
      different +=
          bool(hit) != !places.empty() || (hit && (hit.t != places[0].t || hit.cell != places[0].cell ||
                                                   hit.from_inside != (sides.first < 0)));
      int side = sides.first;
      double t = ray.t_min;
      for (const SurfacePlace& place : places) {
        if (place.kind != PlaceKind::touch) {
          odd_ones_out += side != (place.kind == PlaceKind::enters ? 1 : -1);
          side = -side;
        }
        odd_ones_out += !(place.t >= t && place.t <= ray.t_max);
        t = place.t;
      }
      odd_ones_out += side != sides.last;
      const std::optional<SurfacePlace> farthest = farthest_hit(level_set, ray);
      different += farthest.has_value() != !places.empty() || (farthest && farthest->t != places.back().t);
      hits += bool(hit);
      several += places.size() > 2;
    }
    CAPTURE(shape.name, hits, several);
    CHECK(different == 0);
    CHECK(odd_ones_out == 0);
    CHECK(hits > 500);
    CHECK(several > 50);
  }
}
