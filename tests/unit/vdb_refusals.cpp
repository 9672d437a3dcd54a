// What read_vdb says of files that hold no level set it can use, and of those that nearly do.
#include "levelray/core/error.hpp"
#include "levelray/vdb/vdb_file.hpp"
#include "support/catch.hpp"
#include "support/sphere_grid.hpp"
#include "support/temporary_folder.hpp"

#include <cmath>
#include <fmt/format.h>
#include <fstream>
#include <limits>
#include <openvdb/openvdb.h>
#include <openvdb/tools/LevelSetSphere.h>

using namespace levelray;
using namespace levelray::test;
using openvdb::Coord;
using openvdb::CoordBBox;
using openvdb::FloatGrid;
using openvdb::math::Transform;

namespace {

struct Answer {
  VdbFile file;
  bool failed = false;
  ErrorKind kind{};
  std::string text; // of the error, without the path
};

Answer read(const std::string& path, const std::string& grid = "",
            std::uint64_t max_memory = std::uint64_t{1} << 30) {
  VdbReadOptions options;
  options.trust_input = true;
  options.grid = grid;
  options.max_memory = max_memory;
  Answer answer;
  try {
    answer.file = read_vdb(path, options);
  } catch (const Error& error) {
    answer.failed = true;
    answer.kind = error.kind();
    answer.text = error.what();
    REQUIRE(answer.text.rfind(path, 0) == 0);
    answer.text.erase(0, path.size());
  }
  return answer;
}

// A file of OpenVDB's making.
class Maker {
 public:
  Maker() { openvdb::initialize(); }
  Maker& add(openvdb::GridBase::Ptr grid, const std::string& name,
             openvdb::GridClass kind = openvdb::GRID_LEVEL_SET) {
    grid->setName(name);
    grid->setGridClass(kind);
    grids_.push_back(grid);
    return *this;
  }
  std::string write() {
    const std::string path = folder_ / "a.vdb";
    openvdb::io::File(path).write(grids_);
    return path;
  }
  Answer read_back(const std::string& grid = "", std::uint64_t max_memory = std::uint64_t{1} << 30) {
    return read(write(), grid, max_memory);
  }

 private:
  TemporaryFolder folder_;
  openvdb::GridPtrVec grids_;
};

FloatGrid::Ptr ball(float voxel_size = 1, float half_width = 3) {
  openvdb::initialize();
  return openvdb::tools::createLevelSetSphere<FloatGrid>(6 * voxel_size, openvdb::Vec3f(0), voxel_size,
                                                         half_width);
}

FloatGrid::Ptr ball_with(const openvdb::math::Mat4d& matrix) {
  FloatGrid::Ptr grid = ball();
  grid->setTransform(Transform::createLinearTransform(matrix));
  return grid;
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

bool any_contains(const std::vector<std::string>& texts, const std::string& part) {
  return std::any_of(texts.begin(), texts.end(), [&](const std::string& t) { return contains(t, part); });
}

} // namespace

TEST_CASE("what is no OpenVDB file is named so before OpenVDB sees it") {
  const TemporaryFolder dir;
  const auto write = [&](const std::string& bytes) {
    std::ofstream(dir / "a.vdb", std::ios::binary) << bytes;
  };
  CHECK(read(dir / "none.vdb").text == ": no such file");
  CHECK(read(dir.path()).text == ": is a directory");
  CHECK(read("/dev/null").text == ": is not a regular file");
  write("");
  CHECK(read(dir / "a.vdb").text == ": empty file");
  write("solid cube\n");
  CHECK(read(dir / "a.vdb").text == ": not an OpenVDB file");
  CHECK(read(dir / "a.vdb").kind == ErrorKind::bad_input);
  write(std::string(" BDV\0\0\0\0", 8));
  CHECK(read(dir / "a.vdb").text == ": the file ends early or points beyond its end (truncated or damaged)");
}

TEST_CASE("grids that are no level sets are turned down with the reason and the candidates") {
  Answer answer = Maker().add(ball(), "density", openvdb::GRID_FOG_VOLUME).read_back();
  CHECK(answer.kind == ErrorKind::bad_input);
  CHECK(answer.text == ": grid \"density\" is a fog volume (density), not a level set; --iso 0.5 makes a "
                       "solid of it; has: density [fog volume]");

  answer = Maker().add(openvdb::Vec3SGrid::create(), "v", openvdb::GRID_UNKNOWN).read_back();
  CHECK(answer.text == ": grid \"v\" holds vec3s values; a level set holds float or double; has: v [vec3s]");

  answer = Maker()
               .add(ball(), "density", openvdb::GRID_FOG_VOLUME)
               .add(openvdb::Vec3SGrid::create(), "v", openvdb::GRID_UNKNOWN)
               .read_back();
  CHECK(answer.text == ": no level set: grid \"density\" is a fog volume (density), not a level set; --iso "
                       "0.5 makes a solid of it; has: density [fog "
                       "volume], v [vec3s]");
  answer = Maker().add(ball(), "a", openvdb::GRID_STAGGERED).read_back();
  CHECK(contains(answer.text, "is a staggered grid"));
  answer = Maker().read_back();
  CHECK(answer.text == ": holds no grids");
}

TEST_CASE("grids are chosen by name, by name and index, by index, or because there is only one level set") {
  Maker maker;
  maker.add(ball(1), "a").add(ball(2), "a").add(ball(3), "b").add(ball(4), "", openvdb::GRID_UNKNOWN);
  const auto voxel = [&](const std::string& grid) {
    const Answer answer = maker.read_back(grid);
    CHECK(answer.text == "");
    return answer.file.grid.transform.voxel_size;
  };
  CHECK(voxel("a[0]") == 1);
  CHECK(voxel("a[1]") == 2);
  CHECK(voxel("b") == 3);
  CHECK(voxel("[2]") == 3);
  CHECK(voxel("[3]") == 4);

  const std::string list = "; has: a [level set], a [level set], b [level set], [3] [float]";
  CHECK(maker.read_back("a").text == ": 2 grids are called \"a\"; choose a[0] to a[1]" + list);
  for (const std::string wrong : {"c", "a[2]", "[4]", "b[]", "b[x]", "b[-1]", "[99999999999999999999]"})
    CHECK(maker.read_back(wrong).text == fmt::format(": no grid \"{}\"{}", wrong, list));
  CHECK(maker.read_back().text == ": several grids could be meant; name one, such as [0]" + list);

  Maker one;
  one.add(ball(1), "fog", openvdb::GRID_FOG_VOLUME)
      .add(ball(2), "s")
      .add(ball(3), "odd", openvdb::GRID_UNKNOWN);
  CHECK(one.read_back().file.grid.transform.voxel_size == 2);
  CHECK(one.read_back().file.grid.name == "s");
  CHECK(one.read_back("fog").text == ": grid \"fog\" is a fog volume (density), not a level set; --iso 0.5 "
                                     "makes a solid of it; has: fog [fog volume], s "
                                     "[level set], odd [float]");
}

TEST_CASE("a grid without a class is taken for a level set, with a warning, if it has both signs") {
  Answer answer = Maker().add(ball(), "a", openvdb::GRID_UNKNOWN).read_back();
  CHECK(!answer.failed);
  CHECK(any_contains(answer.file.warnings, "grid \"a\" has no class"));
  FloatGrid::Ptr positive = FloatGrid::create(1);
  positive->fill(CoordBBox(Coord(0), Coord(5)), 0.5f);
  CHECK(Maker().add(positive, "a", openvdb::GRID_UNKNOWN).read_back().text ==
        ": grid \"a\" has no surface: no value is negative");
}

TEST_CASE("empty grids and values that are not finite are turned down") {
  openvdb::initialize();
  CHECK(Maker().add(FloatGrid::create(3), "a").read_back().text == ": grid \"a\" is empty: no active values");

  FloatGrid::Ptr grid = ball();
  grid->tree().setValue(Coord(6, 1, -2), std::nanf(""));
  CHECK(Maker().add(grid, "a").read_back().text ==
        ": grid \"a\" has a value that is not a finite 32-bit number, at sample (6, 1, -2)");
  grid->tree().setValue(Coord(6, 1, -2), std::numeric_limits<float>::infinity());
  CHECK(Maker().add(grid, "a").read_back().kind == ErrorKind::bad_input);
  openvdb::DoubleGrid::Ptr doubles =
      openvdb::tools::createLevelSetSphere<openvdb::DoubleGrid>(6, openvdb::Vec3f(0), 1);
  doubles->tree().setValue(Coord(1, 2, 3), 1e300);
  CHECK(contains(Maker().add(doubles, "a").read_back().text,
                 "not a finite 32-bit number, at sample (1, 2, 3)"));
}

TEST_CASE("transforms other than a uniform scale and a translation are turned down by their kind") {
  openvdb::initialize();
  openvdb::math::Mat4d m = openvdb::math::Mat4d::identity();
  const auto text = [&] { return Maker().add(ball_with(m), "a").read_back().text; };
  CHECK(text() == "");
  m(2, 2) = 2;
  CHECK(contains(text(), ": grid \"a\" has non-uniform voxels, which are not supported: 1 x 1 x 2"));
  m = openvdb::math::Mat4d::identity();
  m(0, 1) = 0.25;
  CHECK(contains(text(), "has sheared voxels"));
  m = openvdb::math::Mat4d::identity();
  m.preRotate(openvdb::math::Z_AXIS, 0.3);
  CHECK(contains(text(), "has rotated voxels"));
  m = openvdb::math::Mat4d::identity();
  m(0, 0) = -1;
  CHECK(contains(text(), "has a mirroring transform"));
  FloatGrid::Ptr frustum = ball();
  frustum->setTransform(
      Transform::createFrustumTransform(openvdb::BBoxd(openvdb::Vec3d(0), openvdb::Vec3d(10)), 0.5, 1.0));
  CHECK(contains(Maker().add(frustum, "a").read_back().text, "has a frustum transform"));
}

TEST_CASE("double grids are rounded, -0 becomes +0, and active tiles become samples") {
  openvdb::initialize();
  openvdb::DoubleGrid::Ptr grid =
      openvdb::tools::createLevelSetSphere<openvdb::DoubleGrid>(6, openvdb::Vec3f(0), 1);
  grid->tree().setValue(Coord(6, 0, 0), -0.0);
  grid->tree().setValue(Coord(6, 0, 1), 0.1);
  grid->tree().addTile(1, Coord(-24, 16, 8), 1.25, true);
  const Answer answer = Maker().add(grid, "a").read_back();
  REQUIRE(answer.text == "");
  CHECK(std::signbit(answer.file.grid.value(6, 0, 0)) == false);
  CHECK(answer.file.grid.value(6, 0, 1) == 0.1f);
  CHECK(answer.file.grid.value(-24, 16, 8) == 1.25f);
  CHECK(answer.file.grid.value(-17, 23, 15) == 1.25f);
  CHECK(answer.file.grid.value(-16, 23, 15) == 3);
  CHECK(answer.file.grid.active_sample_count() == grid->activeVoxelCount());
}

TEST_CASE("background 0 is replaced by the largest value, and a negative one is turned down") {
  openvdb::initialize();
  FloatGrid::Ptr grid = FloatGrid::create(0);
  for (int k = 0; k < 12; ++k)
    for (int j = 0; j < 10; ++j)
      for (int i = 0; i < 8; ++i) grid->tree().setValue(Coord(i, j, k), static_cast<float>(k) - 4.5f);
  Answer answer = Maker().add(grid, "phi").read_back();
  REQUIRE(answer.text == "");
  CHECK(answer.file.grid.background == 6.5f);
  CHECK(answer.file.grid.value(3, 3, -1) == 6.5f); // beyond the samples: outside
  CHECK(answer.file.grid.value(8, 3, 0) == 6.5f);  // an inactive 0 in a leaf too
  CHECK(answer.file.grid.value(3, 3, 0) == -4.5f);
  CHECK(any_contains(answer.file.warnings, "background 0: taken as 6.5"));
  // Cells between the lowest samples and the outside below them are stored, though their lowest corners are
  // not.
  CHECK(answer.file.grid.find_block(3, 3, -1) != nullptr);
  CHECK(answer.file.grid.find_block(-1, -1, -1) != nullptr);

  FloatGrid::Ptr negative = FloatGrid::create(-3);
  negative->fill(CoordBBox(Coord(0), Coord(5)), 0.5f);
  CHECK(contains(Maker().add(negative, "a").read_back().text, "has the background -3"));
}

TEST_CASE("narrow bands and gradients that are not of length 1 are remarked on with numbers") {
  CHECK(any_contains(Maker().add(ball(1, 1.2f), "a").read_back().file.warnings, "only 1.2 voxels wide"));
  FloatGrid::Ptr steep = ball();
  for (auto it = steep->beginValueOn(); it; ++it) it.setValue(std::min(std::max(*it * 1.5f, -2.99f), 2.99f));
  const FieldFacts facts = Maker().add(steep, "a").read_back().file.facts;
  CHECK(facts.gradient_median == Approx(1.5).margin(0.02));
  CHECK(any_contains(Maker().add(steep, "a").read_back().file.warnings,
                     fmt::format("have the median length {:.2f} instead of 1", facts.gradient_median)));
  CHECK(Maker().add(ball(), "a").read_back().file.warnings.empty());
}

TEST_CASE("bombs are refused before memory is taken") {
  openvdb::initialize();
  FloatGrid::Ptr tiles = ball();
  tiles->fill(CoordBBox(Coord(-16384), Coord(16383)), -3.0f, /*active=*/true); // 512 tiles of the root
  Answer answer = Maker().add(tiles, "a").read_back();
  CHECK(answer.kind == ErrorKind::limit);
  CHECK(contains(answer.text, ": grid \"a\" spans 32768 x 32768 x 32768 samples with 3.518e+13 active"));

  FloatGrid::Ptr far = ball();
  far->tree().setValue(Coord(2147483000, 0, 0), -1.0f);
  answer = Maker().add(far, "a").read_back();
  CHECK(answer.kind == ErrorKind::limit);
  CHECK(contains(answer.text, "indices beyond +-1073741824 are not supported"));
  far = ball();
  far->tree().setValue(Coord(-2147483640), -1.0f);
  CHECK(Maker().add(far, "a").read_back().kind == ErrorKind::limit);

  FloatGrid::Ptr apart = ball();
  apart->tree().setValue(Coord(1000000), -1.0f); // the dense table of nodes would be 1 PB
  answer = Maker().add(apart, "a").read_back();
  CHECK(answer.kind == ErrorKind::limit);
  CHECK(contains(answer.text, "at most 1 GiB are allowed"));

  CHECK(Maker().add(ball(), "a").read_back("", 10000).kind == ErrorKind::limit);
}

TEST_CASE("grids that share a tree are read with their own transforms") {
  FloatGrid::Ptr first = ball();
  FloatGrid::Ptr second = FloatGrid::create(first->treePtr());
  second->setTransform(Transform::createLinearTransform(0.5));
  Maker maker;
  maker.add(first, "a").add(second, "b");
  const Answer answer = maker.read_back("b");
  REQUIRE(answer.text == "");
  CHECK(answer.file.grid.transform.voxel_size == 0.5);
  CHECK(answer.file.grid.active_sample_count() == first->activeVoxelCount());
}

TEST_CASE("what cannot be written says why") {
  const TemporaryFolder dir;
  const auto error_of = [](const std::string& path, const BlockGrid& grid, bool half_floats) {
    VdbWriteOptions options;
    options.half = half_floats;
    try {
      write_vdb(path, grid, options);
    } catch (const Error& error) {
      return std::pair(error.kind(), std::string(error.what()));
    }
    return std::pair(ErrorKind::usage, std::string("no error"));
  };
  const BlockGrid good = sphere_grid(5);
  CHECK(error_of(dir / "none/a.vdb", good, false).first == ErrorKind::cannot_write);
  CHECK(contains(error_of(dir / "none/a.vdb", good, false).second, "none/a.vdb: cannot write: No such file"));
  CHECK(contains(error_of("/dev/full", good, false).second,
                 "/dev/full: cannot write: No space left on device"));

  BlockGrid tiny = good;
  tiny.transform.voxel_size = 1.4e-5;
  CHECK(error_of(dir / "a.vdb", tiny, false).first == ErrorKind::limit);
  CHECK(contains(error_of(dir / "a.vdb", tiny, false).second,
                 "voxels of 1.4e-05: the smallest are 1.442e-05; scale"));
  tiny.transform.voxel_size = 1.45e-5;
  CHECK(error_of(dir / "a.vdb", tiny, false).second == "no error");
  BlockGrid huge = good;
  huge.background = 70000;
  CHECK(error_of(dir / "a.vdb", huge, true).first == ErrorKind::limit);
}
