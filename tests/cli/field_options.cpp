// The options that say what a mesh or a field is taken for: --thicken, --redistance, --iso.
#include "levelray/vdb/vdb_file.hpp"
#include "support/catch.hpp"
#include "support/mesh_files.hpp"
#include "support/read_output.hpp"
#include "support/run_program.hpp"
#include "support/sphere_grid.hpp"
#include "support/temporary_folder.hpp"

#include <openvdb/openvdb.h>

using namespace levelray::test;

namespace {

// An open sheet of four triangles, bent along its middle.
const std::string sheet_obj = "v 0 0 0\nv 4 0 0\nv 0 2 1\nv 4 2 1\nv 0 4 0\nv 4 4 0\nf 1 2 4 3\nf 3 4 6 5\n";

} // namespace

TEST_CASE("--thicken makes a sheet and states its thickness") {
  const TemporaryFolder folder;
  write_text(folder / "cloth.obj", sheet_obj);
  const RunResult convert = run_program({"convert", folder / "cloth.obj", folder / "cloth.vdb", "--units",
                                         "cm", "--thicken", "2mm", "--resolution", "40"});
  INFO(convert.err);
  CHECK(convert.code == 0);
  CHECK_THAT(convert.out,
             Catch::Contains("sheet: 0.4 cm thick (4 voxels), half of it on each side of the mesh"));

  const RunResult render = run_program({"render", folder / "cloth.obj", "-o", folder / "cloth.png", "--size",
                                        "64x64", "--thicken", "1.5vx", "--resolution", "40", "--json", "-"});
  INFO(render.err);
  REQUIRE(render.code == 0);
  const Json json = Json::parse(render.out);
  CHECK(json["sheet"]["thickness"].get<double>() == Approx(0.3).epsilon(1e-12));
  CHECK(json["sheet"]["voxels"].get<double>() == Approx(3).epsilon(1e-12));
  CHECK(json["options"]["thicken"] == "1.5vx");
  CHECK(json["hits"].get<int>() > 500);
  CHECK(json["warnings"].empty()); // holes do not matter to a sheet

  // The level set that was written is the same sheet.
  const RunResult info = run_program({"info", folder / "cloth.vdb"});
  CHECK(info.code == 0);
  CHECK(info.err.empty());
}

TEST_CASE("a sheet without --thicken is told of it; one too thin, or with --sign, is refused") {
  const TemporaryFolder folder;
  write_text(folder / "flat.obj", "v 0 0 0\nv 4 0 0\nv 0 4 0\nv 4 4 0\nf 1 2 4 3\n");
  const auto convert = [&](std::vector<std::string> options) {
    options.insert(options.begin(),
                   {"convert", folder / "flat.obj", folder / "flat.vdb", "--resolution", "40"});
    return run_program(options);
  };
  RunResult result = convert({});
  CHECK(result.code == 3);
  CHECK_THAT(result.err, Catch::Contains("--thicken 1.5vx for a thin sheet"));
  result = convert({"--thicken", "0.2vx"});
  CHECK(result.code == 2);
  CHECK_THAT(result.err, Catch::Contains("0.04 thick is thinner than a voxel of 0.1"));
  result = convert({"--thicken", "1vx", "--sign", "winding"});
  CHECK(result.code == 2);
  CHECK_THAT(result.err, Catch::Contains("--sign"));
  result = convert({"--thicken", "-1"});
  CHECK(result.code == 2);
  CHECK_THAT(result.err, Catch::Contains("must be > 0"));
  CHECK(folder.names() == std::vector<std::string>{"flat.obj"});
  result = convert({"--thicken", "0.6vx"});
  CHECK(result.code == 0);
  CHECK_THAT(result.err, Catch::Contains("1.2 voxels thick; below 1.73 it may have holes"));
}

namespace {

// A ball of 8 voxels of 0.5, dense in a box, in half floats; its distance in voxels, not world units.
void write_voxel_units(const std::string& path) {
  using levelray::Box3d, levelray::Vec3d;
  const auto ball = sphere_field(Vec3d(0.1, -0.2, 0.3), 4);
  const levelray::BlockGrid grid = sample_grid([&](const Vec3d& p) { return ball(p) / 0.5; }, 0.5, 100,
                                               Box3d(Vec3d(-7, -6.5, -8), Vec3d(7, 6.5, 8)));
  levelray::VdbWriteOptions options;
  options.half = true;
  levelray::write_vdb(path, grid, options);
}

// A density that falls from 1 in the middle of a ball of 10 unit voxels to 0 at its border: 1 - r / 10.
void write_fog(const std::string& path) {
  openvdb::initialize();
  const openvdb::FloatGrid::Ptr grid = openvdb::FloatGrid::create(0);
  for (int k = -10; k <= 10; ++k)
    for (int j = -10; j <= 10; ++j)
      for (int i = -10; i <= 10; ++i)
        if (const double r = std::sqrt(i * i + j * j + k * k); r < 10)
          grid->tree().setValue(openvdb::Coord(i, j, k), static_cast<float>(1 - r / 10));
  grid->setName("density");
  grid->setGridClass(openvdb::GRID_FOG_VOLUME);
  openvdb::io::File(path).write({grid});
}

} // namespace

TEST_CASE("a field in voxel units is redistanced, and the warning says what it was and what was done") {
  const TemporaryFolder folder;
  write_voxel_units(folder / "phi.vdb");
  const auto render = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"render", folder / "phi.vdb", "-o", folder / "phi.exr", "--size",
                                       "64x64",  "--json",           "-"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    RunResult result = run_program(arguments);
    INFO(result.err);
    REQUIRE(result.code == 0);
    return result;
  };
  RunResult result = render({});
  // Percentiles are right to 0.6 %.
  CHECK_THAT(result.err, Catch::Contains("median length 1.99 instead of 1") ||
                             Catch::Contains("median length 2.00 instead of 1") ||
                             Catch::Contains("median length 2.01 instead of 1"));
  CHECK_THAT(result.err, Catch::Contains("no distances in world units, but near ones in voxels (") &&
                             Catch::Contains("redistanced, which moved the surface by 0.0"));
  CHECK(std::count(result.err.begin(), result.err.end(), '\n') == 1);
  const Json json = Json::parse(result.out);
  CHECK(json["redistanced"]["before"]["is_distance"] == false);
  CHECK(json["redistanced"]["before"]["looks_like_voxel_units"] == true);
  CHECK(json["redistanced"]["after"]["is_distance"] == true);
  CHECK(json["redistanced"]["after"]["gradient"]["median"].get<double>() == Approx(1).margin(0.03));
  CHECK(json["redistanced"]["moved_voxels"]["largest"].get<double>() < 0.1);
  CHECK(json["options"]["redistance"] == "auto");
  CHECK(json["warnings"].size() == 1);

  result = render({"--redistance=never"});
  CHECK_THAT(result.err, Catch::Contains("they are traced as they are"));
  const Json raw = Json::parse(result.out);
  CHECK(!raw.contains("redistanced"));
  CHECK(raw["grid"]["active_samples"] > json["grid"]["active_samples"]);
  // The same ball, but for interpolation: within a pixel along its outline of about 150 pixels.
  CHECK(std::abs(raw["hits"].get<int>() - json["hits"].get<int>()) < 150);

  CHECK_THAT(render({"--redistance", "--band", "5"}).err, Catch::Contains("redistanced"));
  CHECK_THAT(render({"--redistance=never", "--band", "5"}).err, Catch::Contains("no effect on a .vdb"));
}

TEST_CASE("convert makes a level set of distances of a foreign .vdb") {
  const TemporaryFolder folder;
  write_voxel_units(folder / "phi.vdb");
  const RunResult result =
      run_program({"convert", folder / "phi.vdb", folder / "ball.vdb", "--band", "4vx", "--json", "-"});
  INFO(result.err);
  REQUIRE(result.code == 0);
  const Json json = Json::parse(result.out);
  CHECK(json["redistanced"]["surface_cells"] > 500);
  CHECK(!json.contains("sign"));
  const RunResult info = run_program({"info", folder / "ball.vdb", "--json", "-"});
  CHECK(info.err.empty());
  const Json grid = Json::parse(info.out)["grids"][0];
  CHECK(grid["field"]["is_distance"] == true);
  CHECK(grid["half_width_voxels"].get<double>() == Approx(4).epsilon(1e-6));
  CHECK(Json::parse(run_program({"info", folder / "phi.vdb", "--json", "-"})
                        .out)["grids"][0]["field"]["looks_like_voxel_units"] == true);
  // What is a distance is told apart, and stays as it is unless asked.
  const RunResult again = run_program({"convert", folder / "ball.vdb", folder / "again.vdb"});
  CHECK(again.code == 0);
  CHECK(again.err.empty());
  CHECK(again.out.find("redistanced") == std::string::npos);
  const RunResult asked = run_program({"convert", folder / "ball.vdb", folder / "again.vdb", "--redistance"});
  CHECK_THAT(asked.out, Catch::Contains("redistanced: ") && Catch::Contains("the surface moved by 0.0"));
}

TEST_CASE("--redistance takes auto, always and never, and is for .vdb files") {
  const TemporaryFolder folder;
  write_text(folder / "cloth.obj", sheet_obj);
  write_voxel_units(folder / "phi.vdb");
  RunResult result =
      run_program({"render", folder / "phi.vdb", "-o", folder / "a.png", "--redistance=alwys"});
  CHECK(result.code == 2);
  CHECK_THAT(result.err, Catch::Contains("did you mean \"always\""));
  result =
      run_program({"render", folder / "phi.vdb", "-o", folder / "a.png", "--redistance", "--band", "2mm"});
  CHECK(result.code == 2);
  CHECK_THAT(result.err, Catch::Contains("give it in voxels for a .vdb"));
  result = run_program({"convert", folder / "cloth.obj", folder / "a.vdb", "--thicken", "2vx", "--resolution",
                        "30", "--redistance"});
  CHECK(result.code == 0);
  CHECK_THAT(result.err, Catch::Contains("are for .vdb files"));
}

TEST_CASE("--iso takes the surface of a fog volume where its density has that value") {
  const TemporaryFolder folder;
  write_fog(folder / "fog.vdb");
  RunResult result = run_program({"render", folder / "fog.vdb", "-o", folder / "fog.exr"});
  CHECK(result.code == 3);
  CHECK_THAT(result.err, Catch::Contains("is a fog volume") && Catch::Contains("--iso 0.5"));

  // 1 / 2 at a radius of 5: see write_fog.
  result = run_program({"convert", folder / "fog.vdb", folder / "ball.vdb", "--iso", "0.5", "--json", "-"});
  INFO(result.err);
  REQUIRE(result.code == 0);
  CHECK_THAT(result.err, Catch::Contains("redistanced"));
  levelray::VdbReadOptions options;
  const levelray::VdbFile ball = levelray::read_vdb(folder / "ball.vdb", options);
  CHECK(ball.warnings.empty());
  // Interpolation errs by at most 1/8 of the sum of the density's second derivatives, 2 / r / 10 where r is
  // at least 3.3 in cells of the surface, which moves by that over the gradient, 1/10: by 0.076 voxel; and
  // the surface is found to 1/128.
  for (const int axis : {0, 1, 2}) {
    levelray::Vec3i p(0, 0, 0);
    for (p[axis] = 4; p[axis] <= 6; ++p[axis])
      CHECK(std::abs(ball.grid.value(p.x, p.y, p.z) - static_cast<float>(p[axis] - 5)) < 0.1f);
  }
  for (const std::string value : {"0", "-1", "nan", "half"}) {
    result = run_program({"convert", folder / "fog.vdb", folder / "no.vdb", "--iso", value});
    CHECK(result.code == 2);
    CHECK_THAT(result.err, Catch::Contains("--iso"));
  }
  result = run_program({"convert", folder / "fog.vdb", folder / "no.vdb", "--iso", "2"});
  CHECK(result.code == 3);
  CHECK_THAT(result.err, Catch::Contains("no value is negative"));
  result = run_program({"convert", folder / "ball.vdb", folder / "no.vdb", "--iso", "0.5"});
  CHECK(result.code == 3);
  CHECK_THAT(result.err, Catch::Contains("--iso is for densities"));
}
