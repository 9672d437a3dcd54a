// A ray ended one bit before the face in which it leaves the nodes with surface, because that time was
// computed before the ray was moved to where it enters them. Where the cell's other samples are 2^44 times as
// large as those of the face, f was still negative there, and no crossing outward was found.
#include "levelray/measure/made_grids.hpp"
#include "levelray/trace/all_hits.hpp"
#include "levelray/trace/level_set.hpp"
#include "support/catch.hpp"

#include <cfloat>

using namespace levelray;

TEST_CASE("the last crossing before the hull is found, however steep") {
  const float corner[8] = {0x1.89dc62p-102f, -0x1.09p-141f,    -0x1.611f06p+32f, -0x1.b85b82p+126f,
                           0x1.24b7ccp-35f,  0x1.5b34dep-101f, 0x1.667f24p-1f,   0x1.cca5ecp-101f};
  const Vec3i at(15, 15, 15);
  const BlockGrid grid = grid_of_samples(
      at - Vec3i(3, 3, 3), Vec3i(8, 8, 8),
      [&](int i, int j, int k) {
        const Vec3i q = Vec3i(i, j, k) - at;
        if (q.x < 0 || q.y < 0 || q.z < 0 || q.x > 1 || q.y > 1 || q.z > 1) return FLT_MAX;
        return corner[q.x + 2 * q.y + 4 * q.z];
      },
      FLT_MAX);
  const LevelSet level_set(grid);
  WorldRay ray;
  ray.origin = Vec3d(0x1.f318fb7f3597ap+3, 0x1.ea1cd9b7f4538p+3, -0x1.7d4ce247aecc9p+4);
  ray.direction = Vec3d(5e-324, 0, 1);
  std::vector<SurfacePlace> places;
  const EndSides sides = all_hits(level_set, ray, places);
  REQUIRE(places.size() == 2);
  CHECK(places[0].kind == PlaceKind::enters);
  CHECK(places[1].kind == PlaceKind::leaves);
  CHECK(sides.last == 1);
  ray.t_min = places[0].t + 0.25; // from inside
  CHECK(closest_hit(level_set, ray).from_inside);
}
