#include "support/catch.hpp"
#include "support/mesh_files.hpp"
#include "support/run_program.hpp"
#include "support/temporary_folder.hpp"

#include <nlohmann/json.hpp>

using namespace levelray::test;
using Json = nlohmann::json;

TEST_CASE("info tells the topology of a mesh") {
  const TemporaryFolder folder;
  std::string open = box_obj(3, 2, 1);
  open.resize(open.rfind("f 2 4 8 6")); // one side taken off
  write_text(folder / "box.obj", open);
  const RunResult text = run_program({"info", folder / "box.obj"});
  CHECK(text.code == 0);
  CHECK_THAT(text.out,
             Catch::Contains("8 vertices, 10 triangles, open") && Catch::Contains("4 open edges in 1 hole,"));
  const RunResult result = run_program({"info", folder / "box.obj", "--json", "-"});
  REQUIRE(result.code == 0);
  const Json json = Json::parse(result.out);
  CHECK(json["type"] == "mesh");
  CHECK(json["format"] == "obj");
  CHECK(json["input"]["closed"] == false);
  CHECK(json["input"]["boundary_edges"] == 4);
  CHECK(json["input"]["longest_hole"].get<double>() == Approx(std::sqrt(5.0)).epsilon(1e-12));
  CHECK(json["warnings"].size() >= 1);
  CHECK_THAT(result.err, Catch::StartsWith("levelray: warning: "));
  CHECK(run_program({"info", folder / "box.obj", "--strict"}).code == 3);
}

TEST_CASE("info tells the grids of a level set and that samples are vertex-centred") {
  const TemporaryFolder folder;
  write_text(folder / "box.obj", box_obj(3, 2, 1));
  REQUIRE(run_program({"convert", folder / "box.obj", folder / "box.vdb", "--voxel", "0.1"}).code == 0);
  const RunResult text = run_program({"info", folder / "box.vdb"});
  CHECK(text.code == 0);
  CHECK(text.err.empty());
  CHECK_THAT(text.out, Catch::Contains("\"surface\"") && Catch::Contains("level set") &&
                           Catch::Contains("voxel 0.1, background 0.3 (band 3 voxels)") &&
                           Catch::Contains("vertex-centred"));
  const Json json = Json::parse(run_program({"info", folder / "box.vdb", "--json", "-"}).out);
  REQUIRE(json["grids"].size() == 1);
  const Json& grid = json["grids"][0];
  CHECK(grid["name"] == "surface");
  CHECK(grid["traceable"] == true);
  CHECK(grid["background"].get<double>() == Approx(0.3).epsilon(0x1p-23)); // a float, rounded up
  CHECK(grid["active_samples"] > 1000);
  // The band reaches at most 3 voxels beyond the box on either side.
  CHECK(grid["bounds"]["min"][0].get<double>() >= -0.3 - 1e-9);
  CHECK(grid["bounds"]["min"][0].get<double>() < -0.15);
  CHECK(grid["bounds"]["max"][0].get<double>() > 3.15);
}
