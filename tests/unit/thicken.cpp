#include "levelray/convert/thicken.hpp"

#include "levelray/convert/mesh_to_grid.hpp"
#include "levelray/core/error.hpp"
#include "levelray/measure/made_meshes.hpp"
#include "levelray/trace/level_set.hpp"
#include "support/catch.hpp"
#include "support/conversion.hpp"

#include <random>

using namespace levelray;
using namespace levelray::test;
using Catch::Matchers::Contains;

namespace {

// An open, wavy sheet of n by n quads over [-1,1]^2.
TriangleMesh wavy_sheet(std::uint32_t n, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> noise(-0.15, 0.15);
  TriangleMesh mesh;
  for (std::uint32_t j = 0; j <= n; ++j)
    for (std::uint32_t i = 0; i <= n; ++i) {
      mesh.vertices.emplace_back(2.0 * i / n - 1, 2.0 * j / n - 1, noise(random));
      if (i == n || j == n) continue;
      const std::uint32_t a = j * (n + 1) + i, b = a + 1, c = b + n + 1, d = a + n + 1;
      mesh.triangles.push_back({a, b, c});
      mesh.triangles.push_back({a, c, d});
    }
  return mesh;
}

ConvertedGrid thickened(const TriangleMesh& mesh, double voxel_size, double radius, double half_width = 3) {
  ConvertOptions options;
  options.voxel_size = voxel_size;
  options.thicken = radius;
  options.half_width_voxels = half_width;
  return mesh_to_grid(prepare_mesh(mesh), options);
}

std::string refusal(const TriangleMesh& mesh, const ConvertOptions& options, ErrorKind kind) {
  try {
    mesh_to_grid(prepare_mesh(mesh), options);
  } catch (const Error& error) {
    CHECK(error.kind() == kind);
    return error.what();
  }
  FAIL("no error");
  return {};
}

} // namespace

TEST_CASE(
    "every sample of a sheet holds the distance to the mesh less its radius, whatever radius and band") {
  const double h = 0.05;
  struct Case {
    double radius_voxels, half_width;
  };
  // Thinner than the band, as thick, and so thick that its middle is beyond the band.
  for (const Case& c : {Case{0.9, 3}, Case{1.5, 3}, Case{3, 3}, Case{6.3, 2}, Case{1, 1}}) {
    const double radius = c.radius_voxels * h;
    for (const TriangleMesh& mesh :
         {wavy_sheet(7, 31), moebius_mesh(30), box_mesh(Vec3d(-0.5), Vec3d(0.5))}) {
      CAPTURE(c.radius_voxels, c.half_width, mesh.triangles.size());
      const ConvertedGrid result = thickened(mesh, h, radius, c.half_width);
      const BlockGrid& grid = result.grid;
      CHECK(result.report.thickness == 2 * radius);
      CHECK(grid.half_width_voxels() == Approx(c.half_width).epsilon(1e-6));
      const TriangleBvh bvh(mesh);
      std::uint64_t wrong = 0, missing = 0, wrong_signs = 0, active = 0, unbanded = 0;
      const auto exact = [&](const Vec3d& p) {
        const auto nearest = bvh.closest_point(p, 100);
        return std::sqrt(nearest->distance_squared) - radius;
      };
      for_each_sample(grid, [&](int i, int j, int k, float value, bool is_active) {
        const double d = exact(grid.transform.to_world(Vec3d(i, j, k)));
        // The conversion's bound for the distance, and one rounding each of it, of the difference in voxels
        // and of the stored value.
        const double bound = distance_bound(grid, d + radius) + 2 * std::ldexp(std::fabs(d), -24);
        active += is_active;
        if (is_active)
          wrong += !(std::fabs(value - d) <= bound);
        else
          missing += std::fabs(d) < grid.background - bound, unbanded += std::fabs(value) != grid.background;
        if (std::fabs(d) > bound) wrong_signs += std::signbit(value) != (d < 0);
      });
      CHECK(wrong == 0);
      CHECK(missing == 0);
      CHECK(unbanded == 0);
      CHECK(wrong_signs == 0);
      CHECK(active > 1000);
      // Blocks without samples are on the right side, too.
      std::mt19937 random(5);
      std::uniform_real_distribution<double> place(-1.7, 1.7);
      std::uint64_t misplaced = 0;
      for (int n = 0; n < 500; ++n) {
        const Vec3i p(static_cast<int>(place(random) / h), static_cast<int>(place(random) / h),
                      static_cast<int>(place(random) / h));
        const double d = exact(grid.transform.to_world(Vec3d(p)));
        if (std::fabs(d) > 1e-4 * h) misplaced += (grid.value(p.x, p.y, p.z) < 0) != (d < 0);
      }
      CHECK(misplaced == 0);
    }
  }
}

TEST_CASE("rays do not get through flat sheets of the safe thickness, however they are tilted") {
  std::mt19937 random(71);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int tilt = 0; tilt < 30; ++tilt) {
    CAPTURE(tilt);
    Vec3d n(normal(random), normal(random), normal(random));
    if (tilt == 0) n = Vec3d(1, 1, 1); // where sqrt(3) is needed
    if (tilt == 1) n = Vec3d(0, 0, 1);
    n.normalize();
    const Vec3d u = n.cross(std::fabs(n.x) < 0.5 ? Vec3d(1, 0, 0) : Vec3d(0, 1, 0)).normalized(),
                v = n.cross(u);
    const Vec3d centre(unit(random), unit(random), unit(random));
    TriangleMesh mesh;
    for (const double s : {-1.0, 1.0})
      for (const double t : {-1.0, 1.0}) mesh.vertices.push_back(centre + u * (s * 12) + v * (t * 12));
    mesh.triangles = {{0, 1, 3}, {0, 3, 2}};
    const ConvertedGrid result = thickened(mesh, 1, safe_thickness_voxels / 2);
    CHECK(result.report.warnings.empty());
    const LevelSet level_set(result.grid);
    int escaped = 0;
    for (int ray = 0; ray < 2000; ++ray) {
      const Vec3d target = centre + u * (9 * unit(random)) + v * (9 * unit(random));
      Vec3d d = n + Vec3d(unit(random), unit(random), unit(random)) * 0.5;
      escaped += !any_hit(level_set, WorldRay{target - d * 5, d, 0, 10});
    }
    CHECK(escaped == 0);
  }
}

TEST_CASE("sheets that are too thin are refused, doubtful ones warned of, with what to do") {
  const TriangleMesh sheet = wavy_sheet(4, 9);
  ConvertOptions options;
  options.voxel_size = 0.1;
  options.thicken = 0.04;
  CHECK_THAT(refusal(sheet, options, ErrorKind::usage),
             Contains("0.08 thick is thinner than a voxel of 0.1") &&
                 Contains("--thicken 0.15 or --voxel 0.0267"));
  options.thicken = 0.06;
  const ConvertReport report = mesh_to_grid(prepare_mesh(sheet), options).report;
  REQUIRE(report.warnings.size() == 1);
  CHECK_THAT(report.warnings[0], Contains("1.2 voxels thick; below 1.73 it may have holes"));
  options.thicken = 0.1;
  CHECK(mesh_to_grid(prepare_mesh(sheet), options).report.warnings.empty());
  CHECK_THAT(mesh_to_grid(prepare_mesh(box_mesh()), options).report.warnings.at(0), Contains("hollow shell"));
  options.sign = SignMethod::winding;
  CHECK_THAT(refusal(sheet, options, ErrorKind::usage), Contains("leave out --sign"));
  options.sign = SignMethod::automatic;
  options.thicken = -1;
  refusal(sheet, options, ErrorKind::usage);
  options.thicken = NAN;
  refusal(sheet, options, ErrorKind::usage);
  options.thicken = 100;
  CHECK_THAT(refusal(sheet, options, ErrorKind::usage), Contains("2000 voxels from side to side"));
}

TEST_CASE("an open sheet without --thicken is told of it") {
  TriangleMesh flat;
  flat.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
  flat.triangles = {{0, 1, 3}, {0, 3, 2}};
  ConvertOptions options;
  options.resolution = 32;
  CHECK_THAT(refusal(flat, options, ErrorKind::bad_input),
             Contains("no enclosed volume") && Contains("--thicken"));
}

TEST_CASE("what does not matter to a sheet is not warned of") {
  PrepareOptions options;
  options.sheet = true;
  for (TriangleMesh mesh : {wavy_sheet(4, 9), moebius_mesh(20), inverted_mesh(box_mesh())}) {
    CHECK(!prepare_mesh(mesh).warnings.empty());
    CHECK(prepare_mesh(mesh, options).warnings.empty());
    std::swap(mesh.triangles[0][0], mesh.triangles[0][1]); // clashes with its neighbours
    CHECK(prepare_mesh(mesh, options).warnings.empty());
  }
}

TEST_CASE("a sheet's plan covers what its conversion makes") {
  const PreparedMesh mesh = prepare_mesh(wavy_sheet(12, 4));
  for (const double radius : {1.0, 3.0, 8.0}) {
    CAPTURE(radius);
    ConvertOptions options;
    options.voxel_size = 0.02;
    options.thicken = radius * options.voxel_size;
    const ConvertPlan plan = plan_conversion(mesh, options);
    const BlockGrid grid = mesh_to_grid(mesh, options).grid;
    CHECK(plan.bytes > grid.bytes());
    options.max_memory = plan.bytes / 2;
    CHECK_THROWS_AS(mesh_to_grid(mesh, options), Error);
  }
}
