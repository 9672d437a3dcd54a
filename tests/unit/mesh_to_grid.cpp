#include "levelray/convert/mesh_to_grid.hpp"

#include "levelray/core/error.hpp"
#include "levelray/core/parallel.hpp"
#include "levelray/measure/made_meshes.hpp"
#include "support/catch.hpp"
#include "support/conversion.hpp"

#include <cstring>
#include <random>

using namespace levelray;
using namespace levelray::test;
using Catch::Matchers::Contains;

namespace {

// The exact signed distance to a box (Quilez' formula is the same; here by clamping).
double box_distance(const Vec3d& p, const Vec3d& min, const Vec3d& max) {
  Vec3d outside(0);
  double inside = -INFINITY;
  for (int axis = 0; axis < 3; ++axis) {
    const double d = std::max(min[axis] - p[axis], p[axis] - max[axis]);
    outside[axis] = std::max(d, 0.0);
    inside = std::max(inside, d);
  }
  return inside > 0 ? outside.length() : inside;
}

float nearest_value(const BlockGrid& grid, const Vec3d& world) {
  const Vec3d v = grid.transform.to_voxel(world);
  return grid.value(static_cast<int>(std::lround(v.x)), static_cast<int>(std::lround(v.y)),
                    static_cast<int>(std::lround(v.z)));
}

ErrorKind kind_of_error(const TriangleMesh& mesh, const ConvertOptions& options,
                        std::string* text = nullptr) {
  try {
    mesh_to_grid(prepare_mesh(mesh), options);
  } catch (const Error& e) {
    if (text) *text = e.what();
    return e.kind();
  }
  FAIL("no error");
  return ErrorKind::failed;
}

} // namespace

TEST_CASE("a box becomes its signed distance, band and flags") {
  const Vec3d min(-1.3, -0.45, 0.21), max(0.9, 0.7, 1.02);
  const ConvertedGrid result = convert(box_mesh(min, max), 0.031);
  const BlockGrid& grid = result.grid;
  std::uint64_t wrong = 0, expected_active = 0;
  for (int k = -20; k < 60; ++k)
    for (int j = -40; j < 50; ++j)
      for (int i = -70; i < 60; ++i) {
        const double d = box_distance(grid.transform.to_world(Vec3d(i, j, k)), min, max);
        const double clamped = std::clamp(d, -double{grid.background}, double{grid.background});
        expected_active += std::abs(d) < grid.background;
        wrong += !(std::abs(grid.value(i, j, k) - clamped) <= distance_bound(grid, d));
      }
  CHECK(wrong == 0);
  CHECK(grid.active_sample_count() == expected_active);
  CHECK(result.report.sign == SignMethod::winding);
  CHECK_THAT(result.report.sign_reason, Contains("encloses"));
}

TEST_CASE("a box whose faces lie on samples, or half way between them, keeps its sides") {
  for (const double shift : {0.0, 0.5, 0.25}) {
    CAPTURE(shift);
    const Vec3d min = Vec3d(-8, -4, 3) + Vec3d(shift), max = Vec3d(9, 12, 20) + Vec3d(shift);
    const BlockGrid grid = convert(box_mesh(min, max), 1).grid;
    std::uint64_t wrong = 0;
    for_each_sample(grid, [&](int i, int j, int k, float value, bool) {
      const double d = box_distance(Vec3d(i, j, k), min, max);
      wrong += !(std::abs(value - std::clamp(d, -3.0, 3.0)) <= 1e-5);
    });
    CHECK(wrong == 0);
    CHECK(grid.value(0, 4, 10) == -3);
    CHECK(grid.value(100, 4, 10) == 3);
  }
}

TEST_CASE("nested shells stay hollow, and only `flood` fills them") {
  const TriangleMesh mesh =
      joined_meshes(box_mesh(Vec3d(-1), Vec3d(1)), inverted_mesh(box_mesh(Vec3d(-0.6), Vec3d(0.6))));
  CHECK(nearest_value(convert(mesh, 0.05).grid, Vec3d(0)) > 0);
  CHECK(nearest_value(convert(mesh, 0.05).grid, Vec3d(0.8, 0, 0)) < 0);
  CHECK(nearest_value(convert(mesh, 0.05, SignMethod::winding_abs).grid, Vec3d(0)) > 0);
  CHECK(nearest_value(convert(mesh, 0.05, SignMethod::pseudonormal).grid, Vec3d(0)) > 0);
  CHECK(nearest_value(convert(mesh, 0.05, SignMethod::flood).grid, Vec3d(0)) < 0);
}

TEST_CASE("an inverted mesh is turned, an inverted hollow one as a whole") {
  const TriangleMesh hollow =
      joined_meshes(box_mesh(Vec3d(-1), Vec3d(1)), inverted_mesh(box_mesh(Vec3d(-0.6), Vec3d(0.6))));
  CHECK(nearest_value(convert(inverted_mesh(box_mesh()), 0.05).grid, Vec3d(0.5)) < 0);
  const BlockGrid grid = convert(inverted_mesh(hollow), 0.05).grid;
  CHECK(nearest_value(grid, Vec3d(0)) > 0);
  CHECK(nearest_value(grid, Vec3d(0.8, 0, 0)) < 0);
}

TEST_CASE("a gap of 0.2 voxels between two boxes stays a gap, and a wall of 0.2 voxels a wall") {
  const double h = 0.1;
  for (const double at : {0.03, 0.04, 0.1}) { // where the gap begins, of a sample at 0.05 .. 0.15
    const TriangleMesh boxes = joined_meshes(box_mesh(Vec3d(-1, -1, -1), Vec3d(at, 1, 1)),
                                             box_mesh(Vec3d(at + 0.2 * h, -1, -1), Vec3d(1, 1, 1)));
    const BlockGrid grid = convert(boxes, h).grid;
    std::uint64_t wrong = 0;
    for_each_sample(grid, [&](int i, int j, int k, float value, bool) {
      const Vec3d p(i * h, j * h, k * h);
      const double d = std::min(box_distance(p, Vec3d(-1, -1, -1), Vec3d(at, 1, 1)),
                                box_distance(p, Vec3d(at + 0.2 * h, -1, -1), Vec3d(1, 1, 1)));
      wrong += std::abs(d) > 1e-5 * h && std::signbit(value) != (d < 0);
    });
    CHECK(wrong == 0);
  }
  const BlockGrid wall =
      convert(box_mesh(Vec3d(-0.01, -1, -1), Vec3d(0.01, 1, 1)), h).grid; // around the samples x = 0
  CHECK(wall.value(0, 0, 0) < 0);
  CHECK(wall.value(1, 0, 0) > 0);
  CHECK(wall.value(-1, 0, 0) > 0);
}

TEST_CASE("parts thinner than a voxel are pointed out") {
  const TriangleMesh wall = joined_meshes(box_mesh(Vec3d(0.03, -1, -1), Vec3d(0.05, 1, 1)),
                                          box_mesh(Vec3d(0.5, -1, -1), Vec3d(1.5, 1, 1)));
  const ConvertedGrid result = convert(wall, 0.1);
  REQUIRE(result.report.warnings.size() == 1);
  CHECK_THAT(result.report.warnings[0], Contains("thinner"));
  CHECK(convert(box_mesh(), 0.1).report.warnings.empty());
}

TEST_CASE("a box without a lid is closed by its winding number") {
  const TriangleMesh open = without_triangles(box_mesh(Vec3d(-1), Vec3d(1)), 10, 2);
  const ConvertedGrid result = convert(open, 0.07);
  CHECK(nearest_value(result.grid, Vec3d(0, 0, 0)) < 0);
  CHECK(nearest_value(result.grid, Vec3d(0, 0, 1.3)) > 0);
  CHECK_THAT(result.report.sign_reason, Contains("4 open edges"));
  // Every sample by the sum of all solid angles; the rim's plane itself is undecided.
  std::uint64_t wrong = 0;
  for_each_sample(result.grid, [&](int i, int j, int k, float value, bool) {
    const double w = winding_number(open, result.grid.transform.to_world(Vec3d(i, j, k)));
    wrong += std::abs(w - 0.5) > 1e-6 && std::signbit(value) != (w > 0.5);
  });
  CHECK(wrong == 0);
}

TEST_CASE("a surface that is cracked along every edge is signed as the closed one") {
  const TriangleMesh torus = torus_mesh(60, 30, 1, 0.33);
  TriangleMesh cracked;
  std::mt19937_64 rng(4);
  std::uniform_real_distribution<double> jitter(-1e-6, 1e-6);
  for (const Triangle& t : torus.triangles) {
    const auto v = static_cast<std::uint32_t>(cracked.vertices.size());
    for (const std::uint32_t i : t)
      cracked.vertices.push_back(torus.vertices[i] + Vec3d(jitter(rng), jitter(rng), jitter(rng)));
    cracked.triangles.push_back({v, v + 1, v + 2});
  }
  const ConvertedGrid closed = convert(torus, 0.06), open = convert(cracked, 0.06);
  CHECK_THAT(open.report.warnings.at(0), Contains("10800 open edges"));
  std::uint64_t compared = 0, wrong = 0;
  for_each_sample(closed.grid, [&](int i, int j, int k, float value, bool) {
    if (std::abs(value) < 1e-4) return; // 50 times the jitter: nearer samples have lost their side
    ++compared;
    wrong += std::signbit(value) != std::signbit(open.grid.value(i, j, k));
  });
  CHECK(compared > 20000);
  CHECK(wrong == 0);
}

TEST_CASE("a sheet encloses nothing: an error, unless unsigned distances are asked for") {
  TriangleMesh sheet;
  sheet.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  sheet.triangles = {{0, 1, 2}, {0, 2, 3}};
  ConvertOptions options;
  options.voxel_size = 0.05;
  std::string text;
  CHECK(kind_of_error(sheet, options, &text) == ErrorKind::bad_input);
  CHECK_THAT(text, Contains("no enclosed volume") && Contains("--sign unsigned"));
  const BlockGrid grid = convert(sheet, 0.05, SignMethod::unsigned_distance).grid;
  CHECK(grid.value(10, 10, 0) == 0);
  CHECK(grid.value(10, 10, 1) == Approx(0.05).epsilon(1e-6)); // one float's rounding
  CHECK(grid.value(10, 10, -1) == Approx(0.05).epsilon(1e-6));
  CHECK(grid.value(10, 10, -40) == grid.background);
}

TEST_CASE("sizes that make no sense are usage errors, sizes that do not fit are limits") {
  ConvertOptions options;
  for (const double voxel : {-1.0, 1e300, std::nan(""), 2.0}) {
    CAPTURE(voxel);
    options.voxel_size = voxel;
    CHECK(kind_of_error(box_mesh(), options) == ErrorKind::usage);
  }
  options.voxel_size = 1e-7;
  CHECK(kind_of_error(box_mesh(), options) == ErrorKind::limit);
  options.voxel_size = 0.01;
  options.max_memory = 1 << 20;
  std::string text;
  CHECK(kind_of_error(box_mesh(), options, &text) == ErrorKind::limit);
  CHECK_THAT(text, Contains("--max-memory"));
  options = {};
  options.half_width_voxels = 0.5;
  CHECK(kind_of_error(box_mesh(), options) == ErrorKind::usage);
}

TEST_CASE("the plan counts the samples of bands that are wide against the mesh") {
  const PreparedMesh box = prepare_mesh(box_mesh());
  for (const double half_width : {3.0, 10.0, 40.0}) {
    ConvertOptions options;
    options.resolution = 12;
    options.half_width_voxels = half_width;
    const ConvertPlan plan = plan_conversion(box, options);
    const BlockGrid grid = mesh_to_grid(box, options).grid;
    CAPTURE(half_width, plan.active_samples, grid.active_sample_count(), plan.bytes, grid.bytes());
    // Never too few: 5 % stand for counting lattice points instead of a volume. At most twice as many:
    // inside, where the two sides of the band meet, the formula counts what the mesh has no room for.
    CHECK(static_cast<double>(plan.active_samples) > 0.95 * static_cast<double>(grid.active_sample_count()));
    CHECK(plan.active_samples < 2 * grid.active_sample_count());
    CHECK(plan.bytes > grid.bytes());
  }
  ConvertOptions options;
  options.resolution = 64;
  options.half_width_voxels = 1000;
  options.max_memory = std::uint64_t{16} << 30;
  CHECK(kind_of_error(box_mesh(), options) == ErrorKind::limit);
}

TEST_CASE("any half-width gives exact distances and a whole band") {
  const TriangleMesh torus = torus_mesh(40, 24, 1, 0.33);
  for (const double half_width : {1.0, 1.5, 2.0, 4.7}) {
    CAPTURE(half_width);
    const BlockGrid grid = convert(torus, 0.05, SignMethod::automatic, half_width).grid;
    const PreparedMesh prepared = prepare_mesh(torus);
    const TriangleBvh bvh(prepared.mesh);
    const BandErrors errors = band_errors(grid, prepared.mesh, [&](const Vec3d& p) {
      return winding_by_ray(bvh, p, Vec3d(0.31, 0.17, 1)) == 1;
    });
    CHECK(errors.missing == 0);
    CHECK(errors.wrong_signs == 0);
    CHECK_FALSE(errors.beyond_bound);
    CHECK(errors.samples > 1000);
  }
}

TEST_CASE("a mesh far from the origin converts as exactly as one at the origin") {
  const Vec3d far(1.2e7, -3.4e6, 5e5);
  const TriangleMesh torus = torus_mesh(40, 24, 1, 0.33), moved = moved_mesh(torus, far);
  const BlockGrid grid = convert(moved, 1e-2 * 5).grid;
  const PreparedMesh prepared = prepare_mesh(moved);
  const TriangleBvh bvh(prepared.mesh);
  const BandErrors errors = band_errors(
      grid, prepared.mesh, [&](const Vec3d& p) { return winding_by_ray(bvh, p, Vec3d(0.31, 0.17, 1)) == 1; });
  CHECK(errors.missing == 0);
  CHECK(errors.wrong_signs == 0);
  CHECK_FALSE(errors.beyond_bound);
}

TEST_CASE("slivers, needles and triangles without area count for distances as what they are") {
  TriangleMesh mesh = box_mesh(Vec3d(-1), Vec3d(1));
  // A needle beside the box, doubled so that it encloses nothing, a collinear triangle and one of two equal
  // corners' width.
  const auto add = [&](const Vec3d& a, const Vec3d& b, const Vec3d& c) {
    const auto v = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const Vec3d& p : {a, b, c}) mesh.vertices.push_back(p);
    mesh.triangles.push_back({v, v + 1, v + 2});
    mesh.triangles.push_back({v, v + 2, v + 1});
  };
  add(Vec3d(1.5, -1, 0.1), Vec3d(1.7, 1, 0.2), Vec3d(1.7, 1, 0.2 + 1e-9));
  add(Vec3d(-1, -1.7, 0), Vec3d(0, -1.8, 0.5), Vec3d(1, -1.9, 1));
  add(Vec3d(-1.5, 0, 0), Vec3d(-1.5, 0, 1e-12), Vec3d(-1.5, 1e-12, 0));
  const BlockGrid grid = convert(mesh, 0.043).grid;
  std::uint64_t wrong = 0;
  for_each_sample(grid, [&](int i, int j, int k, float value, bool is_active) {
    const double d =
        std::sqrt(closest_point_brute_force(mesh, grid.transform.to_world(Vec3d(i, j, k))).distance_squared);
    if (is_active)
      wrong += !(std::abs(std::abs(value) - d) <= distance_bound(grid, d));
    else
      wrong += d < grid.background - distance_bound(grid, d);
  });
  CHECK(wrong == 0);
}

TEST_CASE("the same bytes come out for 1, 2 and 7 threads") {
  const TriangleMesh torus = without_triangles(torus_mesh(60, 30, 1, 0.33), 100, 7);
  std::vector<BlockGrid> grids;
  for (const int threads : {1, 2, 7}) {
    const ThreadLimit limit(threads);
    grids.push_back(convert(torus, 0.02).grid);
  }
  for (std::size_t i = 1; i < grids.size(); ++i) {
    CHECK(grids[i].node_table == grids[0].node_table);
    CHECK(grids[i].active == grids[0].active);
    CHECK(grids[i].cells == grids[0].cells);
    REQUIRE(grids[i].values.size() == grids[0].values.size());
    CHECK(std::memcmp(grids[i].values.data(), grids[0].values.data(),
                      grids[0].values.size() * sizeof(float)) == 0);
  }
}
