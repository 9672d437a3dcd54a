// A hit at the very end of an interval was reported one unit in the last place behind it.
#include "levelray/trace/level_set.hpp"
#include "support/catch.hpp"
#include "support/trace_fixtures.hpp"

using namespace levelray;
using namespace levelray::test;

TEST_CASE("no hit lies beyond its ray's interval") {
  const BlockGrid grid = slab_grid(0.8, 12);
  const LevelSet level_set(grid);
  RandomRays random(5);
  std::size_t beyond = 0, hits = 0;
  for (int i = 0; i < 30000; ++i) {
    WorldRay ray = random.through(active_box(grid));
    const Hit hit = closest_hit(level_set, ray);
    if (!hit) continue;
    for (const double direction : {-1.0, 1.0}) {
      ray.t_max = std::nextafter(hit.t, direction * 1e9);
      const Hit cut = closest_hit(level_set, ray);
      hits += bool(cut);
      beyond += cut && !(cut.t <= ray.t_max && cut.t_outside <= ray.t_max);
    }
  }
  CHECK(hits > 1000);
  CHECK(beyond == 0);
}
