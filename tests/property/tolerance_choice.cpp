#include "levelray/core/error.hpp"
#include "levelray/core/parallel.hpp"
#include "levelray/measure/made_meshes.hpp"
#include "levelray/measure/method_costs.hpp"
#include "levelray/measure/ray_sets.hpp"
#include "levelray/measure/surface_judge.hpp"
#include "levelray/measure/tolerance.hpp"
#include "support/catch.hpp"

#include <algorithm>

using namespace levelray;

namespace {

ToleranceRequest length_request(double world) {
  ToleranceRequest request;
  request.world = [world](const LevelSet&) { return world; };
  request.guess = world;
  return request;
}

// Turned and off the lattice, so that no edge lies on a plane of samples.
TriangleMesh turned_box(const Vec3d& size) {
  TriangleMesh mesh = box_mesh(size * -0.5, size * 0.5);
  const Vec3d x = Vec3d(0.7, 0.3, 0.2).normalized(), z = x.cross(Vec3d(0.1, 0.9, 0.3)).normalized();
  const Vec3d y = z.cross(x);
  for (Vec3d& v : mesh.vertices) v = x * v.x + y * v.y + z * v.z + Vec3d(0.013, -0.021, 0.037);
  return mesh;
}

} // namespace

TEST_CASE("a chosen configuration meets its tolerance by rays of other seeds, and is not far from failing") {
  struct Case {
    const char* name;
    TriangleMesh mesh;
    double tolerance;
  };
  const Case cases[] = {{"turned box", turned_box({1, 0.7, 0.4}), 0.004},
                        {"torus", torus_mesh(96, 48, 1, 0.4), 0.01},
                        {"tetrahedron", tetrahedron_mesh(), 0.01}};
  for (const Case& c : cases) {
    INFO(c.name);
    const PreparedMesh prepared = prepare_mesh(c.mesh);
    const ToleranceResult result = convert_to_tolerance(prepared, length_request(c.tolerance));
    REQUIRE(result.end == ToleranceEnd::met);
    REQUIRE(result.converted);
    const BlockGrid& grid = result.converted->grid;
    CHECK(grid.transform.voxel_size == result.voxel_size);
    CHECK(result.achieved.p999 <= c.tolerance);
    CHECK(result.achieved.p999 <= result.achieved.largest);
    CHECK(result.achieved.rays >= 19000);
    // The search ends within an eighth of the tolerance or at voxels that fail when a twelfth larger.
    CHECK(result.achieved.demonstrated >= 0.7 * c.tolerance);
    const LevelSet level_set(grid);
    const MeshTruth truth(prepared);
    const std::vector<WorldRay> rays = random_chords(truth.bounds(), 30000, 77);
    const auto places = first_places(truth, rays);
    const SurfaceErrors errors =
        SurfaceJudge(truth, level_set, rays, places).errors(result.intersector, c.tolerance);
    CHECK(errors.quantile() <= c.tolerance);
  }
}

TEST_CASE("voxels are made finer where the rays of a picture are worth it, and not for a few") {
  const PreparedMesh prepared = prepare_mesh(box_mesh({0, 0, 0}, {1, 1, 1}));
  ToleranceRequest request = length_request(0.01);
  request.picture_rays = 1;
  const ToleranceResult few = convert_to_tolerance(prepared, request);
  request.picture_rays = 1e9;
  const ToleranceResult many = convert_to_tolerance(prepared, request);
  REQUIRE(few.end == ToleranceEnd::met);
  REQUIRE(many.end == ToleranceEnd::met);
  CHECK(many.voxel_size < few.voxel_size);
  // By their counted steps, which is what finer voxels were taken for.
  const auto steps = [&](const ToleranceResult& result) {
    const LevelSet level_set(result.converted->grid);
    const std::vector<WorldRay> rays = random_chords(prepared.report.bounds, 1 << 14, 3);
    std::vector<Hit> hits(rays.size());
    closest_hits(level_set, rays, PrimaryOptions(), hits);
    double cost = 0;
    for (const Hit& hit : hits) cost += ray_cost(hit.counts.steps, hit.counts.tests);
    return cost * intersector_cost(result.intersector);
  };
  CHECK(steps(many) < 0.95 * steps(few));
}

TEST_CASE("normals that are chosen do not jump between cells, however large the tolerance") {
  const PreparedMesh prepared = prepare_mesh(torus_mesh(64, 32, 1, 0.4));
  for (const double tolerance : {0.1, 0.01}) {
    const ToleranceResult result = convert_to_tolerance(prepared, length_request(tolerance));
    REQUIRE(result.end == ToleranceEnd::met);
    CHECK(result.normals != "analytic");
  }
}

TEST_CASE("explicit methods, voxels and storage win, or are refused with what they can") {
  const PreparedMesh prepared = prepare_mesh(turned_box({1, 0.7, 0.4}));
  ToleranceRequest request = length_request(0.01);
  request.intersector = "marmitt";
  request.normals = "dual-voxel";
  request.stored = true;
  request.half = false;
  ToleranceResult result = convert_to_tolerance(prepared, request);
  CHECK(result.end == ToleranceEnd::met);
  CHECK(result.intersector == "marmitt");
  CHECK(result.normals == "dual-voxel");
  CHECK_FALSE(result.half);

  request = length_request(0.001);
  request.fixed_voxel = true;
  request.convert.voxel_size = 0.05;
  result = convert_to_tolerance(prepared, request);
  CHECK(result.end == ToleranceEnd::fixed);
  CHECK(result.voxel_size == 0.05);
  CHECK_FALSE(result.converted);
  REQUIRE(result.closest > 0.001);
  REQUIRE(result.closest < 0.05);
  const double closest = result.closest;
  request.world = [closest](const LevelSet&) { return closest; };
  result = convert_to_tolerance(prepared, request);
  CHECK(result.end == ToleranceEnd::met);
  CHECK(result.converted->grid.transform.voxel_size == 0.05);
  CHECK_THROWS_AS(convert_to_tolerance(prepared,
                                       [] {
                                         ToleranceRequest bad = length_request(0.01);
                                         bad.intersector = "guess";
                                         return bad;
                                       }()),
                  Error);
}

TEST_CASE("a tolerance beyond the memory limit is refused with the closest that fits, and that one fits") {
  const PreparedMesh prepared = prepare_mesh(turned_box({1, 0.7, 0.4}));
  ToleranceRequest request = length_request(0.0005);
  request.convert.max_memory = 4 << 20;
  const ToleranceResult refused = convert_to_tolerance(prepared, request);
  REQUIRE(refused.end == ToleranceEnd::limited);
  CHECK_FALSE(refused.converted);
  REQUIRE(refused.closest > 0.0005);
  ToleranceRequest closest = length_request(refused.closest);
  closest.convert.max_memory = request.convert.max_memory;
  CHECK(convert_to_tolerance(prepared, closest).end == ToleranceEnd::met);
}

TEST_CASE("a mesh of which parts enclose nothing is refused, however fine the voxels") {
  // A box and a lone square beside it, which no sign gives an inside.
  TriangleMesh mesh = box_mesh(Vec3d(0.003), Vec3d(1.003));
  const auto n = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const Vec3d& v : {Vec3d(1.5, 0, 0.1), Vec3d(2.5, 0, 0.1), Vec3d(2.5, 1, 0.2), Vec3d(1.5, 1, 0.2)})
    mesh.vertices.push_back(v);
  mesh.triangles.push_back({n, n + 1, n + 2});
  mesh.triangles.push_back({n, n + 2, n + 3});
  const ToleranceResult result = convert_to_tolerance(prepare_mesh(mesh), length_request(0.02));
  CHECK(result.end == ToleranceEnd::unreachable);
  CHECK(result.closest > 0.1);
}

TEST_CASE("the choice is the same for any number of threads") {
  const PreparedMesh prepared = prepare_mesh(torus_mesh(32, 16, 1, 0.4));
  ToleranceRequest request = length_request(0.02);
  request.stored = true;
  const ToleranceResult all = convert_to_tolerance(prepared, request);
  const ThreadLimit limit(1);
  const ToleranceResult one = convert_to_tolerance(prepared, request);
  CHECK(one.voxel_size == all.voxel_size);
  CHECK(one.intersector == all.intersector);
  CHECK(one.normals == all.normals);
  CHECK(one.half == all.half);
  CHECK(one.achieved.p999 == all.achieved.p999);
  CHECK(one.achieved.largest == all.achieved.largest);
  CHECK(std::equal(one.converted->grid.values.begin(), one.converted->grid.values.end(),
                   all.converted->grid.values.begin(), all.converted->grid.values.end()));
}

TEST_CASE("of a grid the cheapest intersector within the tolerance is taken, and exact meets any") {
  const PreparedMesh prepared = prepare_mesh(torus_mesh(64, 32, 1, 0.4));
  ConvertOptions options;
  options.voxel_size = 0.05;
  const BlockGrid grid = mesh_to_grid(prepared, options).grid;
  // A voxel and its diagonal lie between a surface cell's middle and anything in it.
  CHECK(trace_to_tolerance(grid, length_request(0.1)).intersector == "midpoint");
  const ToleranceResult fine = trace_to_tolerance(grid, length_request(1e-6));
  CHECK(fine.end == ToleranceEnd::met);
  CHECK(intersector_cost(fine.intersector) > intersector_cost("midpoint"));
  CHECK(fine.achieved.p999 <= 1e-6);
  CHECK_FALSE(fine.converted);
  ToleranceRequest request = length_request(1e-6);
  request.stored = true;
  CHECK_FALSE(trace_to_tolerance(grid, request).half); // 2^-12 of a voxel is 1.2e-5
  request.world = [](const LevelSet&) { return 1e-3; };
  CHECK(trace_to_tolerance(grid, request).half);
  request = length_request(1e-6);
  request.intersector = "midpoint";
  const ToleranceResult refused = trace_to_tolerance(grid, request);
  CHECK(refused.end == ToleranceEnd::fixed);
  CHECK(refused.closest < 0.1);
}
