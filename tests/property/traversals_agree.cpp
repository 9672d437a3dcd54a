// Leaping and stepping see the same cells, in the same order, to the last bit; and so does either with any
// bounds that hold.
#include "levelray/accel/cell_walk.hpp"
#include "levelray/accel/plain_walk.hpp"
#include "support/catch.hpp"
#include "support/trace_fixtures.hpp"

#include <algorithm>

using namespace levelray;
using namespace levelray::test;

namespace {

struct Seen {
  double in, out;
  int position[3];
  CellSegment segment;
};

bool same_point(const CellPoint& a, const CellPoint& b) {
  return std::equal(a.x, a.x + 3, b.x) && std::equal(a.rest, a.rest + 3, b.rest);
}

bool same_bits(const Seen& a, const Seen& b) {
  return a.in == b.in && a.out == b.out && std::equal(a.position, a.position + 3, b.position) &&
         std::equal(a.segment.corner, a.segment.corner + 8, b.segment.corner) &&
         same_point(a.segment.in, b.segment.in) && same_point(a.segment.out, b.segment.out);
}

std::vector<Seen> leaping(const SurfaceBlocks& surface, RayFrame frame) {
  std::vector<Seen> seen;
  WalkCounts counts;
  bool entered = true;
  skip_empty_nodes(surface, {&frame, 1}, {&entered, 1});
  if (entered)
    walk_cells(surface, frame, counts, [&](const VisitedCell& cell) {
      seen.push_back(
          {cell.in, cell.out, {cell.position[0], cell.position[1], cell.position[2]}, cell.segment});
      return false;
    });
  return seen;
}

std::vector<Seen> stepping(const SurfaceBlocks& surface, const RayFrame& frame) {
  std::vector<Seen> seen;
  WalkCounts counts;
  walk_cells_plainly(surface, frame, counts, [&](const VisitedCell& cell) {
    seen.push_back({cell.in, cell.out, {cell.position[0], cell.position[1], cell.position[2]}, cell.segment});
    return false;
  });
  return seen;
}

bool same(const std::vector<Seen>& a, const std::vector<Seen>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), same_bits);
}

// Rays along and through the lattice: origins on samples, corners of blocks or nodes, directions of small
// integers, so that several planes are crossed at the same time.
WorldRay lattice_ray(RandomRays& random, const Box3d& box) {
  WorldRay ray;
  const double unit[] = {0.5, 1, 4, 16};
  const double spacing = unit[static_cast<int>(random.uniform(0, 4))];
  do {
    for (int a = 0; a < 3; ++a) ray.direction[a] = std::floor(random.uniform(-2, 3));
  } while (ray.direction == Vec3d(0, 0, 0));
  const Vec3d p = random.in_box(box);
  for (int a = 0; a < 3; ++a) ray.origin[a] = std::floor(p[a] / spacing) * spacing;
  if (random.uniform(0, 1) < 0.5) ray.origin -= ray.direction * (64 * std::floor(random.uniform(0, 4)));
  if (random.uniform(0, 1) < 0.2) ray.t_max = std::floor(random.uniform(0, 64));
  return ray;
}

} // namespace

TEST_CASE("stepping sees the cells that leaping sees, ties included, whatever bounds are known") {
  std::vector<Shape> shapes{
      {"torus", torus_grid(30, 9)}, {"plate", slab_grid(1.2, 34)}, {"gyroid", gyroid_grid(26)}};
  // A cube on the lattice, whose faces lie on the planes of nodes: rays hit edges of nodes exactly.
  shapes.push_back(
      {"cube on node planes", sample_grid(
                                  [](const Vec3d& p) {
                                    return std::max({std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)}) - 32;
                                  },
                                  1, 3, Box3d(Vec3d(-40, -40, -40), Vec3d(40, 40, 40)))});
  for (const Shape& shape : shapes) {
    CAPTURE(shape.name);
    const SurfaceBlocks surface(shape.grid);
    RandomRays random(91);
    const Box3d box = active_box(shape.grid);
    std::size_t cells = 0, ties = 0, narrowed = 0;
    for (int i = 0; i < 6000; ++i) {
      WorldRay ray = i % 2 ? lattice_ray(random, box) : random.through(box);
      if (i % 4 == 2) ray.origin = random.in_box(box);
      RayFrame frame;
      if (!enter_box(surface, shape.grid.transform, ray, frame)) continue;
      const std::vector<Seen> seen = leaping(surface, frame);
      CAPTURE(i, ray.origin, ray.direction, ray.t_max);
      if (const std::vector<Seen> stepped = stepping(surface, frame); !same(seen, stepped)) {
        for (const auto* list : {&seen, &stepped})
          for (const Seen& cell : *list)
            UNSCOPED_INFO((list == &seen ? "leaping " : "stepping ")
                          << cell.in << " " << cell.out << " at " << cell.position[0] << " "
                          << cell.position[1] << " " << cell.position[2]);
        FAIL();
      }
      cells += seen.size();
      for (const Seen& cell : seen) ties += cell.in == cell.out;

      RayFrame boxed = frame;
      if (narrow_frame_to_blocks(surface, boxed)) {
        REQUIRE(same(seen, stepping(surface, boxed)));
        REQUIRE(same(seen, leaping(surface, boxed)));
      } else {
        REQUIRE(seen.empty());
      }
      // Bounds that hold exactly, then wider ones.
      for (const double slack : {0.0, random.uniform(0, 10), random.uniform(0, 100)}) {
        RayFrame bounded = frame;
        if (seen.empty()) break;
        double near = seen.front().in, far = seen.front().out;
        for (const Seen& cell : seen) near = std::min(near, cell.in), far = std::max(far, cell.out);
        REQUIRE(narrow_frame(surface, bounded, frame.t(near) - slack, frame.t(far) + slack));
        narrowed += bounded.start > 0 || bounded.last < bounded.end;
        REQUIRE(same(seen, stepping(surface, bounded)));
        REQUIRE(same(seen, leaping(surface, bounded)));
      }
    }
    CHECK(cells > 10000);
    CHECK(ties > 500); // zero-length visits did occur
    CHECK(narrowed > 3000);
  }
}
