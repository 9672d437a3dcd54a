#include "levelray/vdb/peer.hpp"
#include "levelray/vdb/vdb_file.hpp"
#include "support/catch.hpp"
#include "support/sphere_grid.hpp"
#include "support/temporary_folder.hpp"

#include <algorithm>
#include <cmath>
#include <random>

using namespace levelray;
using namespace levelray::test;

namespace {

TriangleMesh octahedron(double r) {
  TriangleMesh mesh;
  mesh.vertices = {{r, 0, 0}, {-r, 0, 0}, {0, r, 0}, {0, -r, 0}, {0, 0, r}, {0, 0, -r}};
  mesh.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  return mesh;
}

} // namespace

TEST_CASE("OpenVDB finds nothing wrong with our level sets") {
  const TemporaryFolder dir;
  for (const double voxel : {1.0, 0.01, 37.5}) {
    CAPTURE(voxel);
    const BlockGrid grid = sphere_grid(30, 3, voxel);
    CHECK(OpenVdbLevelSet::from_grid(grid).check() == "");
    write_vdb(dir / "a.vdb", grid);
    const OpenVdbLevelSet file = OpenVdbLevelSet::from_file(dir / "a.vdb");
    CHECK(file.check() == "");
    CHECK(file.active_sample_count() == grid.active_sample_count());
    // As 16-bit floats the background may round to a little below 3 voxels, and check 4 wants at least 3.
    VdbWriteOptions options;
    options.half = true;
    write_vdb(dir / "h.vdb", grid, options);
    const std::string complaint = OpenVdbLevelSet::from_file(dir / "h.vdb").check();
    CAPTURE(complaint);
    CHECK((complaint.empty() || complaint.find("is less than 3 voxel units") != std::string::npos));
    CHECK(std::count(complaint.begin(), complaint.end(), '\n') <= 1);
  }
}

TEST_CASE("a file of OpenVDB's making is as good as its level set in memory") {
  const TriangleMesh mesh = octahedron(20);
  PeerTime time;
  const OpenVdbLevelSet level_set = OpenVdbLevelSet::from_mesh(mesh, 1, 3, Vec3d(0.5, 0, 0), &time);
  CHECK(time.wall_ms > 0);
  const BlockGrid grid = level_set.to_grid();
  CHECK(grid.transform.origin == Vec3d(0.5, 0, 0));
  CHECK(grid.active_sample_count() == level_set.active_sample_count());
  CHECK(grid.background == 3);
  // |x| + |y| + |z| = 20 seen from (21.5, 0, 0): the nearest point is the corner (20, 0, 0).
  CHECK(grid.value(21, 0, 0) == Approx(1.5).margin(1e-5));
  CHECK(grid.value(0, 0, 0) == -3);
}

TEST_CASE("OpenVDB's tracer hits a sphere where it is, for rays of any length of direction") {
  const BlockGrid grid = sphere_grid(30, 3, 0.1);
  const Vec3d centre(-0.23, 0.17, 0.04);
  const OpenVdbLevelSet level_set = OpenVdbLevelSet::from_grid(grid);
  std::mt19937 random(3);
  INFO("seed 3");
  std::normal_distribution<double> normal;
  std::vector<WorldRay> rays(3000);
  for (WorldRay& ray : rays) {
    const Vec3d from = Vec3d(normal(random), normal(random), normal(random)).normalized() * 10;
    const Vec3d to = Vec3d(normal(random), normal(random), normal(random)).normalized() * 2;
    ray.origin = centre + from;
    ray.direction = (to - from) * 0.3;
  }
  std::vector<PeerHit> hits(rays.size());
  level_set.trace(rays, hits);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    // Every ray passes within 2 of the centre of the sphere of radius 3.
    REQUIRE(hits[i].hit);
    const Vec3d p = rays[i].at(hits[i].t) - centre;
    // Trilinear interpolation of a distance with curvature 1/30 per voxel is off by at most 3/8 / 30 voxel
    // (second differences along three axes), and OpenVDB's linear search ends within about half a voxel at
    // worst (peers: p99.9 0.1, max 0.5 voxel).
    CHECK(std::fabs(p.length() - 3) < 0.05);
    CHECK(hits[i].normal.dot(p.normalized()) > 0.99);
  }
}
