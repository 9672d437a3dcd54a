// The min/max buffer against brute force over the corners of cells.
#include "levelray/accel/minmax_buffer.hpp"
#include "levelray/core/parallel.hpp"
#include "support/catch.hpp"
#include "support/random_cameras.hpp"

#include <cstring>

using namespace levelray;
using namespace levelray::test;

namespace {

PinholeView view_of(const Camera& camera) {
  PinholeView view{camera.settings().eye, camera.right(), camera.up(), camera.forward()};
  view.half_height = camera.half_height();
  view.half_width = view.half_height * camera.settings().width / camera.settings().height;
  return view;
}

// Points of the surface cells: corners, and anything between.
std::vector<Vec3d> points_of_cells(const BlockGrid& grid, RandomRays& random, std::size_t count) {
  std::vector<Vec3i> cells;
  for (const BlockGrid::Node& node : grid.nodes)
    for (int bit = 0; bit < 64; ++bit) {
      if (!(node.stored >> bit & 1)) continue;
      const std::uint64_t mask = grid.cells[BlockGrid::block_index(node, bit)];
      for (int c = 0; c < 64; ++c)
        if (mask >> c & 1)
          cells.push_back(node.coord * node_dim + Vec3i(bit_x(bit), bit_y(bit), bit_z(bit)) * block_dim +
                          Vec3i(bit_x(c), bit_y(c), bit_z(c)));
    }
  std::vector<Vec3d> points;
  while (points.size() < count) {
    const Vec3i& cell = cells[static_cast<std::size_t>(random.uniform(0, double(cells.size()) - 0.5))];
    Vec3d p;
    for (int a = 0; a < 3; ++a)
      p[a] = cell[a] + (points.size() % 2 ? random.uniform(0, 1) : std::round(random.uniform(0, 1)));
    points.push_back(grid.transform.to_world(p));
  }
  return points;
}

} // namespace

TEST_CASE("whatever point of a surface cell a camera sees lies within the min/max buffer's bounds") {
  const BlockGrid grid = torus_grid(17, 5);
  const SurfaceBlocks surface(grid);
  RandomRays random(3);
  std::size_t seen = 0;
  for (int i = 0; i < 200; ++i) {
    const Camera camera(random_camera(random, active_box(grid), i, 64, 40));
    const int resolution = 1 + static_cast<int>(random.uniform(0, 150));
    CAPTURE(i, resolution, camera.settings().eye, camera.settings().target, camera.settings().fov_degrees);
    const PinholeView view = view_of(camera);
    const MinMaxBuffer buffer(surface, grid.transform, view, resolution);
    std::size_t wrong = 0;
    for (const Vec3d& p : points_of_cells(grid, random, 2000)) {
      const Vec3d d = p - view.eye;
      const double z = d.dot(view.forward);
      // Only what the camera sees, with a doubt of 1e-9 of the distance that also goes for the image
      // position.
      if (!(z > 1e-6 * d.length())) continue;
      const double x = 0.5 + 0.5 * d.dot(view.right) / z / view.half_width;
      const double y = 0.5 - 0.5 * d.dot(view.up) / z / view.half_height;
      if (!(x >= 0 && x <= 1 && y >= 0 && y <= 1)) continue;
      ++seen;
      const RayBounds bounds = buffer.at(x, y);
      wrong +=
          !(static_cast<double>(bounds.near) <= d.length() && d.length() <= static_cast<double>(bounds.far));
    }
    REQUIRE(wrong == 0);
  }
  CHECK(seen > 100000);
}

TEST_CASE("the min/max buffer is tight: a block's bounds are those of its cells, and empty cells are empty") {
  // One cell of one block: the cube [5,6]^3, seen from the front.
  BlockGrid grid;
  grid.background = 3;
  grid.node_min = Vec3i(0, 0, 0), grid.node_dims = Vec3i(1, 1, 1);
  grid.node_table = {0};
  BlockGrid::Node node;
  node.coord = Vec3i(0, 0, 0);
  node.stored = std::uint64_t{1} << (1 + 4 + 16);
  grid.nodes.push_back(node);
  grid.values.resize(samples_per_block, 1.f);
  grid.active.push_back(~std::uint64_t{0});
  grid.cells.push_back(std::uint64_t{1} << (1 + 4 + 16));
  const SurfaceBlocks surface(grid);

  CameraSettings settings;
  settings.eye = Vec3d(5.5, 5.5, 16), settings.target = Vec3d(5.5, 5.5, 5.5);
  settings.width = settings.height = 100;
  settings.fov_degrees = 90;
  const Camera camera(settings);
  const MinMaxBuffer buffer(surface, grid.transform, view_of(camera), 100);
  // The near face at depth 10 spans slopes of +-0.05: image positions 0.475 to 0.525, cells 47 to 52.
  int filled = 0;
  for (int y = 0; y < 100; ++y)
    for (int x = 0; x < 100; ++x) {
      const RayBounds bounds = buffer.cells()[static_cast<std::size_t>(100 * y + x)];
      const bool covered = x >= 47 && x <= 52 && y >= 47 && y <= 52;
      REQUIRE((bounds.near <= bounds.far) == covered);
      if (!covered) continue;
      ++filled;
      // From the middle of the near face to a corner of the far one; the margins are 2^-16 voxel.
      CHECK(double(bounds.near) == Approx(10).margin(1e-4));
      CHECK(double(bounds.far) == Approx(std::sqrt(11 * 11 + 0.5)).margin(1e-4));
    }
  CHECK(filled == 36);
}

TEST_CASE("the min/max buffer has the same bytes for any number of threads") {
  const BlockGrid grid = gyroid_grid(20);
  const SurfaceBlocks surface(grid);
  RandomRays random(5);
  for (int i = 0; i < 8; ++i) {
    const Camera camera(random_camera(random, active_box(grid), i, 64, 64));
    std::vector<RayBounds> first;
    for (const int threads : {1, 2, 3, 7}) {
      const ThreadLimit limit(threads);
      const MinMaxBuffer buffer(surface, grid.transform, view_of(camera), 77);
      if (first.empty()) first = buffer.cells();
      REQUIRE(std::memcmp(first.data(), buffer.cells().data(), first.size() * sizeof(RayBounds)) == 0);
    }
  }
}

TEST_CASE("a camera out of reach, behind everything, or before an empty grid") {
  const BlockGrid grid = torus_grid(8, 3);
  const SurfaceBlocks surface(grid);
  PinholeView view{Vec3d(1e200, 0, 0), Vec3d(0, 1, 0), Vec3d(0, 0, 1), Vec3d(-1, 0, 0)};
  const MinMaxBuffer far(surface, grid.transform, view, 4);
  for (const RayBounds& bounds : far.cells()) { // nothing is claimed
    CHECK(bounds.near < 0);
    CHECK(bounds.far > 1e38f);
  }
  view.eye = Vec3d(-1000, 0, 0); // looks away
  const MinMaxBuffer behind(surface, grid.transform, view, 4);
  for (const RayBounds& bounds : behind.cells()) CHECK(bounds.near > bounds.far);
  const MinMaxBuffer empty(SurfaceBlocks(), grid.transform, view, 4);
  for (const RayBounds& bounds : empty.cells()) CHECK(bounds.near > bounds.far);
}
