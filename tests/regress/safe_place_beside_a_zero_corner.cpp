// A ray that cuts the corner of a cell by a zero sample has a piece of 10^-15 voxel there, on which f is tiny
// all along: that was called safely outside, and t_outside lay where f < 0 by rounding.
#include "levelray/intersect/intersectors.hpp"
#include "levelray/measure/made_grids.hpp"
#include "levelray/measure/ray_judge.hpp"
#include "levelray/trace/level_set.hpp"
#include "support/catch.hpp"

using namespace levelray;

TEMPLATE_LIST_TEST_CASE("other rays begin where f is surely positive, beside zero samples too", "",
                        Intersectors) {
  // One cell of corners -1 but for a 0, in the outside.
  const Vec3i at(15, 15, 15);
  const BlockGrid grid = grid_of_samples(
      at - Vec3i(3, 3, 3), Vec3i(8, 8, 8),
      [&](int i, int j, int k) {
        const Vec3i q = Vec3i(i, j, k) - at;
        if (q.x < 0 || q.y < 0 || q.z < 0 || q.x > 1 || q.y > 1 || q.z > 1) return 4.f;
        return q == Vec3i(0, 1, 0) ? 0.f : -1.f;
      },
      4);
  const LevelSet level_set(grid);
  WorldRay ray;
  ray.origin = Vec3d(-0x1.228cd088a493ap+3, 0x1.40a334222924ep+5, -0x1.228cd088a493ap+3);
  ray.direction = Vec3d(1, -1, 1);
  const Hit hit = closest_hit(level_set, ray, TestType::name);
  REQUIRE(hit);
  CHECK(hit.t_outside <= hit.t);
  CHECK(RayJudge(grid).sign_at(ray, hit.t_outside) > 0);
}
