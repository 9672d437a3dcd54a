// Fields as simulations write them, through a file: what read_vdb makes of them.
#include "levelray/core/error.hpp"
#include "levelray/vdb/vdb_file.hpp"
#include "support/catch.hpp"
#include "support/conversion.hpp"
#include "support/temporary_folder.hpp"

#include <openvdb/openvdb.h>

using namespace levelray;
using namespace levelray::test;
using openvdb::Coord;
using openvdb::CoordBBox;
using openvdb::FloatGrid;

namespace {

// Mantaflow's way: a dense box of 32 x 32 x 48 samples, distances in voxels that are cut off at `most`, half
// floats, background 0. Far regions are active tiles where `tiles` says so.
FloatGrid::Ptr dense_ball(double voxel_size, const Vec3d& centre, double radius, float most, bool tiles) {
  openvdb::initialize();
  FloatGrid::Ptr grid = FloatGrid::create(0);
  grid->setTransform(openvdb::math::Transform::createLinearTransform(voxel_size));
  if (tiles) grid->fill(CoordBBox(Coord(0), Coord(31, 31, 47)), most, /*active=*/true);
  for (int k = 0; k < 48; ++k)
    for (int j = 0; j < 32; ++j)
      for (int i = 0; i < 32; ++i) {
        const float d = static_cast<float>((Vec3d(i, j, k) - centre).length() - radius);
        if (!tiles || d < most) grid->tree().setValue(Coord(i, j, k), std::clamp(d, -most, most));
      }
  grid->setSaveFloatAsHalf(true);
  grid->setName("phi");
  return grid;
}

VdbFile read_back(const std::vector<openvdb::GridBase::Ptr>& grids, const std::string& name = "phi",
                  Redistance redistance = Redistance::automatic) {
  const TemporaryFolder folder;
  openvdb::io::File(folder / "fluid.vdb").write(openvdb::GridCPtrVec(grids.begin(), grids.end()));
  VdbReadOptions options;
  options.grid = name;
  options.redistance = redistance;
  options.trust_input = true;
  return read_vdb(folder / "fluid.vdb", options);
}

// The worst error of the band's samples, in voxels, against the ball.
double worst_error(const BlockGrid& grid, const Vec3d& centre, double radius) {
  double worst = 0;
  for_each_sample(grid, [&](int i, int j, int k, float value, bool active) {
    const double d = (Vec3d(i, j, k) - centre).length() - radius;
    if (active) worst = std::max(worst, std::fabs(value / grid.transform.voxel_size - d));
  });
  return worst;
}

bool any_contains(const std::vector<std::string>& texts, const std::string& part) {
  return std::any_of(texts.begin(), texts.end(),
                     [&](const std::string& t) { return t.find(part) != t.npos; });
}

} // namespace

TEST_CASE(
    "dense half floats in voxel units become distances, whatever class, background, tiles and cut-off") {
  const Vec3d centre(15.3, 16.1, 22.4);
  const double radius = 9.7;
  // Interpolation errs by at most 1/8 of the sum of the second derivatives, 2 / r with r at least 7.9 in
  // cells of the surface; half floats below 2 are right to 2^-11, over a gradient of 1; the surface is found
  // to 1/128.
  const double bound = 2 / 7.9 / 8 + std::ldexp(1, -11) + 1.0 / 128 + 1e-5;
  struct Case {
    double h;
    float most, background;
    bool tiles;
  };
  for (const auto& [h, most, background, tiles] :
       {Case{0.678731, 5, 0, false}, Case{0.678731, 2.6f, 0, true}, Case{0.678731, 5, 10000, true},
        Case{0.02, 5, 0.3f, false}, Case{0.02, 2.6f, 0.3f, true}, Case{0.02, 2.6f, 10000, false}}) {
    CAPTURE(h, most, background, tiles);
    FloatGrid::Ptr grid = dense_ball(h, centre, radius, most, tiles);
    if (background > 0) grid->tree().root().setBackground(background, false);
    if (background == 0.3f)
      grid->setGridClass(openvdb::GRID_UNKNOWN);
    else
      grid->setGridClass(openvdb::GRID_LEVEL_SET);
    const VdbFile file = read_back({grid});
    REQUIRE(file.redistanced);
    CHECK(file.facts.looks_like_voxel_units());
    CHECK(file.grid.half_width_voxels() == Approx(3).epsilon(1e-6));
    CHECK(worst_error(file.grid, centre, radius) < bound);
    CHECK(file.grid.value(15, 16, 22) == -file.grid.background);
    CHECK(file.grid.value(1, 1, 1) == file.grid.background);
    CHECK(file.grid.value(100, 16, 22) == file.grid.background);
    CHECK(any_contains(file.warnings, "but near ones in voxels ("));
    CHECK(any_contains(file.warnings, "redistanced, which moved the surface by 0.0"));
    CHECK(any_contains(file.warnings, "has no class") == (background == 0.3f));
  }
}

TEST_CASE("one grid of many is taken by name or index, whichever frame's topology") {
  const auto frame = [](double radius) {
    std::vector<openvdb::GridBase::Ptr> grids{openvdb::Vec3SGrid::create()};
    grids[0]->setName("velocity");
    for (const char* name : {"phi", "phi_previous"}) {
      FloatGrid::Ptr grid = dense_ball(0.5, Vec3d(15, 15, 20), radius, 5, false);
      grid->setName(name);
      grid->setGridClass(openvdb::GRID_LEVEL_SET);
      grids.push_back(grid);
      radius += 1;
    }
    return grids;
  };
  CHECK_THROWS_AS(read_back(frame(7), ""), Error); // which of the two?
  std::uint64_t active = 0;
  // As above: 2 / r / 8, r at least 2.4.
  for (const double radius : {4.2, 6.3, 8.4}) {
    const VdbFile phi = read_back(frame(radius), "phi"), second = read_back(frame(radius), "[2]");
    CHECK(worst_error(phi.grid, Vec3d(15, 15, 20), radius) < 0.12);
    CHECK(worst_error(second.grid, Vec3d(15, 15, 20), radius + 1) < 0.12);
    CHECK(second.grid.name == "phi_previous");
    CHECK(phi.grid.active_sample_count() > active);
    active = phi.grid.active_sample_count();
  }
}

TEST_CASE("what is a distance is redistanced only when asked to, and never when not") {
  FloatGrid::Ptr grid = dense_ball(1, Vec3d(15, 15, 20), 8, 5, false); // a voxel is a world unit: a distance
  grid->setGridClass(openvdb::GRID_LEVEL_SET);
  CHECK(!read_back({grid}).redistanced);
  CHECK(read_back({grid}).facts.is_distance());
  const VdbFile asked = read_back({grid}, "phi", Redistance::always);
  REQUIRE(asked.redistanced);
  CHECK(!any_contains(asked.warnings, "no distances"));
  for (auto v = grid->beginValueOn(); v; ++v) v.setValue(*v * 2);
  const VdbFile never = read_back({grid}, "phi", Redistance::never);
  CHECK(!never.redistanced);
  CHECK(any_contains(never.warnings, "they are traced as they are"));
  CHECK(never.grid.active_sample_count() == 32 * 32 * 48);
}

TEST_CASE("a fog volume is read as a solid at the density asked for") {
  const auto fog = [](auto grid) {
    using Value = typename decltype(grid)::element_type::ValueType;
    for (int k = 0; k < 24; ++k)
      for (int j = 0; j < 24; ++j)
        for (int i = 0; i < 24; ++i)
          if (const double d = 1 - (Vec3d(i, j, k) - Vec3d(11.5)).length() / 10; d > 0)
            grid->tree().setValue(Coord(i, j, k), static_cast<Value>(d));
    grid->fill(CoordBBox(Coord(-32, -32, -32), Coord(-17, -17, -17)), 2, true); // tiles, dense inside
    grid->setName("density");
    grid->setGridClass(openvdb::GRID_FOG_VOLUME);
    return grid;
  };
  openvdb::initialize();
  const TemporaryFolder folder;
  for (const bool wide : {false, true}) {
    const openvdb::GridBase::Ptr grid =
        wide ? openvdb::GridBase::Ptr(fog(openvdb::DoubleGrid::create(0))) : fog(FloatGrid::create(0));
    openvdb::io::File(folder / "fog.vdb").write({grid});
    for (const bool trust : {false, true}) {
      VdbReadOptions options;
      options.trust_input = trust;
      CHECK_THROWS_AS(read_vdb(folder / "fog.vdb", options), Error);
      options.iso = 0.25f;
      const BlockGrid solid = read_vdb(folder / "fog.vdb", options).grid;
      CHECK(solid.value(12, 12, 12) == Approx(0.25 - (1 - std::sqrt(0.75) / 10)).epsilon(1e-6)); // a float's
      CHECK(solid.value(0, 0, 0) == 0.25f);                                                      // no density
      CHECK(solid.value(50, 0, 0) == 0.25f);                                                     // nor beyond
      CHECK(solid.value(-20, -20, -20) == -1.75f);
      CHECK(solid.background == 0.25f);
    }
  }
}
