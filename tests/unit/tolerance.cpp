#include "levelray/convert/mesh_to_grid.hpp"
#include "levelray/core/error.hpp"
#include "levelray/intersect/intersectors.hpp"
#include "levelray/measure/half_storage.hpp"
#include "levelray/measure/made_meshes.hpp"
#include "levelray/measure/method_costs.hpp"
#include "levelray/measure/ray_sets.hpp"
#include "levelray/measure/surface_judge.hpp"
#include "levelray/normal/normals.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <set>

using namespace levelray;

namespace {

std::set<std::string> as_set(const std::vector<std::string>& names) {
  return {names.begin(), names.end()};
}

} // namespace

TEST_CASE("every intersector and every normal scheme has a measured cost, and nothing else has") {
  CHECK(as_set(intersectors_by_cost()) == as_set(method_names<Intersectors>()));
  CHECK(as_set(normals_by_cost()) == as_set(method_names<NormalSchemes>()));
  CHECK(intersector_cost("exact") == 1);
  const std::vector<std::string> names = intersectors_by_cost();
  for (std::size_t i = 1; i < names.size(); ++i)
    CHECK(intersector_cost(names[i - 1]) <= intersector_cost(names[i]));
  CHECK_THROWS_AS(intersector_cost("guess"), Error);
}

TEST_CASE("a sample of errors demonstrates no more than chance allows") {
  // Poisson, mean 20: P(X <= 10) = 0.0108, P(X <= 11) = 0.0214, P(X <= 12) = 0.0390. Mean 3.688: e^-3.688 =
  // 0.02502 > 1/40 > e^-3.689.
  CHECK(allowed_exceedances(20000) == 11);
  CHECK(allowed_exceedances(3688) == -1);
  CHECK(allowed_exceedances(3689) == 0);
  SurfaceErrors errors;
  for (int i = 0; i < 20000; ++i) errors.errors.push_back(i);
  CHECK(errors.demonstrated() == 19999 - 11);
  CHECK(errors.quantile() == Approx(19980).margin(1)); // ceil(0.999 n) in rounded arithmetic
  errors.errors.back() = std::numeric_limits<double>::infinity();
  errors.lost = 1;
  CHECK(errors.largest() == 19998);
}

TEST_CASE("the judge sees a fin that fell between the samples, though what rays hit instead is right") {
  // A cube of 1 with a fin of half the size, 0.3 voxels thick.
  TriangleMesh mesh = joined_meshes(box_mesh(Vec3d(0.003), Vec3d(1.003)),
                                    box_mesh(Vec3d(1.003, 0.2, 0.507), Vec3d(1.503, 0.8, 0.516)));
  const PreparedMesh prepared = prepare_mesh(mesh);
  ConvertOptions options;
  options.voxel_size = 0.03;
  const BlockGrid grid = mesh_to_grid(prepared, options).grid;
  const LevelSet level_set(grid);
  const MeshTruth truth(prepared);
  const std::vector<WorldRay> rays = random_chords(truth.bounds(), 20000, 7);
  const auto places = first_places(truth, rays);
  const SurfaceJudge judge(truth, level_set, rays, places);
  const SurfaceErrors errors = judge.errors("exact", 0.01);
  CHECK(errors.rays() > 4000);
  CHECK(errors.lost == 0);
  // Some rays meet the fin near its outer edge, half a unit from all that is left; at creases the error is
  // below a voxel.
  CHECK(errors.largest() > 0.3);
  const auto near =
      std::count_if(errors.errors.begin(), errors.errors.end(), [](double e) { return e < 0.03; });
  CHECK(static_cast<double>(near) > 0.8 * static_cast<double>(errors.rays()));
}

TEST_CASE("on a plane the distance to the zero set is exact, and a hit's distance to the mesh too") {
  const PreparedMesh prepared = prepare_mesh(box_mesh(Vec3d(0.003), Vec3d(1.003)));
  ConvertOptions options;
  options.voxel_size = 0.05;
  const BlockGrid grid = mesh_to_grid(prepared, options).grid;
  const LevelSet level_set(grid);
  for (const double off : {-0.08, -0.01, 0.0, 0.02, 0.07}) {
    CAPTURE(off);
    const Vec3d p(0.5, 0.45, 1.003 + off);
    // Samples are floats: 2^-24 of 0.15, and the interpolant of a plane's distances is that plane.
    CHECK(distance_to_zero_set(level_set, p, Vec3d(0, 0, 0), 10) == Approx(std::fabs(off)).margin(1e-7));
    CHECK(MeshTruth(prepared).distance(p, std::numeric_limits<double>::infinity()) ==
          Approx(std::fabs(off)).margin(1e-15));
    CHECK(MeshTruth(prepared, 0.02).distance(p, 1) == Approx(std::fabs(std::fabs(off) - 0.02)).margin(1e-15));
    CHECK(GridTruth(level_set).distance(p, std::numeric_limits<double>::infinity()) ==
          Approx(std::fabs(off)).margin(1e-7));
  }
}

TEST_CASE("what closes a hole is not judged, and all else of an open mesh is") {
  const PreparedMesh open =
      prepare_mesh(without_triangles(box_mesh(Vec3d(0.003), Vec3d(1.003)), 10, 2)); // no lid
  const MeshTruth truth(open);
  CHECK(std::isnan(truth.distance(Vec3d(0.5, 0.5, 1.003), 1)));
  CHECK(truth.distance(Vec3d(0.5, 0.5, 0.1), 1) == Approx(0.097));
  WorldRay down;
  down.origin = Vec3d(0.5, 0.5, 5), down.direction = Vec3d(0, 0, -1);
  CHECK_FALSE(truth.first_place(down)); // the floor's back, through the hole
  down.origin = Vec3d(0.5, 0.5, -5), down.direction = Vec3d(0, 0, 1);
  REQUIRE(truth.first_place(down));
  CHECK(truth.first_place(down)->t == Approx(5.003));
}

TEST_CASE("a sheet's first places lie at its radius from the mesh") {
  const PreparedMesh prepared = prepare_mesh(tetrahedron_mesh());
  const MeshTruth truth(prepared, 0.1);
  std::size_t found = 0;
  for (const WorldRay& ray : random_chords(truth.bounds(), 200, 5))
    if (const auto place = truth.first_place(ray)) {
      ++found;
      CHECK(truth.distance(place->position, 1) < 1e-6);
      CHECK(place->normal.dot(ray.direction) < 1e-3);
    }
  CHECK(found > 30);
}

TEST_CASE("values of a grid stored as half are rounded to halves, and zeros are positive") {
  const PreparedMesh prepared = prepare_mesh(torus_mesh(24, 12, 1, 0.4));
  ConvertOptions options;
  options.resolution = 32;
  BlockGrid grid = mesh_to_grid(prepared, options).grid;
  std::size_t nearest = 0; // to the surface, inside: its neighbours are stored
  for (std::size_t i = 0; i < grid.values.size(); ++i)
    if (grid.values[i] < 0 && (grid.values[nearest] > 0 || grid.values[i] > grid.values[nearest]))
      nearest = i;
  grid.values[nearest] = -1e-9f;
  const auto rounded = rounded_to_half(grid);
  REQUIRE(rounded);
  REQUIRE(rounded->values.size() == grid.values.size());
  CHECK((rounded->values[nearest] == 0 && !std::signbit(rounded->values[nearest])));
  double largest = 0; // of |difference| over |value|
  for (std::size_t i = 0; i < grid.values.size(); ++i)
    if (std::fabs(grid.values[i]) > 1e-4f)
      largest = std::max(largest,
                         double(std::fabs(rounded->values[i] - grid.values[i]) / std::fabs(grid.values[i])));
  CHECK(largest <= 0x1p-11);
  CHECK(largest > 0x1p-13);
  grid.values[nearest] = 1e6f;
  CHECK_FALSE(rounded_to_half(grid));
}
