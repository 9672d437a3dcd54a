#include "support/catch.hpp"
#include "support/mesh_files.hpp"
#include "support/read_output.hpp"
#include "support/run_program.hpp"
#include "support/temporary_folder.hpp"

#include <fstream>
#include <set>

using namespace levelray::test;

TEST_CASE("convert reports the mesh, the voxels, the sign and the file") {
  const TemporaryFolder folder;
  write_text(folder / "box.obj", box_obj(3, 2, 1));
  const RunResult result = run_program({"convert", folder / "box.obj", folder / "box.vdb"});
  CHECK(result.code == 0);
  CHECK(result.err.empty());
  CHECK_THAT(result.out,
             Catch::Contains("8 vertices, 12 triangles, closed, manifold, outward; size 3 x 2 x 1") &&
                 Catch::Contains("voxel 0.01172 (longest side = 256)") && Catch::Contains("sign: ") &&
                 Catch::Contains("wrote " + (folder / "box.vdb")));
  CHECK(folder.names() == std::vector<std::string>{"box.obj", "box.vdb"});
}

TEST_CASE("convert's JSON has the documented keys and nothing else goes to standard output") {
  const TemporaryFolder folder;
  write_text(folder / "box.obj", box_obj(3, 2, 1));
  const RunResult result =
      run_program({"convert", folder / "box.obj", folder / "box.vdb", "--resolution", "30", "--json", "-"});
  REQUIRE(result.code == 0);
  const Json json = Json::parse(result.out);
  CHECK(keys(json) == std::set<std::string>{"input", "sign", "grid", "ms", "warnings"});
  CHECK(keys(json["input"]) == std::set<std::string>{"vertices", "triangles", "components", "boundary_edges",
                                                     "non_manifold_edges", "closed", "orientation"});
  CHECK(keys(json["sign"]) == std::set<std::string>{"method", "reason"});
  CHECK(keys(json["grid"]) ==
        std::set<std::string>{"voxel_size", "dims", "blocks", "active_samples", "bytes"});
  CHECK(keys(json["ms"]) == std::set<std::string>{"read", "distance", "sign", "write", "total"});
  CHECK(json["input"]["triangles"] == 12);
  CHECK(json["input"]["closed"] == true);
  CHECK(json["input"]["orientation"] == "outward");
  CHECK(json["grid"]["voxel_size"] == 0.1);
  // 30 voxels and less than 3 more on either side: samples at distance 3 exactly are no longer in the band.
  CHECK(json["grid"]["dims"][0].get<int>() >= 30 + 4);
  CHECK(json["grid"]["dims"][0].get<int>() <= 30 + 7);
  CHECK(json["warnings"].is_array());
}

TEST_CASE("quiet prints nothing, and JSON to a file is written beside results for people") {
  const TemporaryFolder folder;
  write_text(folder / "box.obj", box_obj(3, 2, 1));
  const RunResult quiet = run_program({"convert", folder / "box.obj", folder / "box.vdb", "-q"});
  CHECK(quiet.code == 0);
  CHECK((quiet.out + quiet.err).empty());
  const RunResult both =
      run_program({"convert", folder / "box.obj", folder / "box.vdb", "--json", folder / "report.json"});
  CHECK(both.code == 0);
  CHECK_THAT(both.out, Catch::Contains("wrote"));
  CHECK(Json::parse(content_of(folder / "report.json"))["grid"]["active_samples"] > 0);
}

TEST_CASE("sizes take units, and the grid follows them") {
  const TemporaryFolder folder;
  write_text(folder / "box.obj", box_obj(30, 20, 10));
  const auto voxel = [&](const std::vector<std::string>& options) {
    std::vector<std::string> arguments{"convert", folder / "box.obj", folder / "box.vdb", "--json", "-"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const RunResult result = run_program(arguments);
    INFO(result.err);
    REQUIRE(result.code == 0);
    return Json::parse(result.out)["grid"]["voxel_size"].get<double>();
  };
  CHECK(voxel({"--voxel", "0.5mm", "--units", "mm"}) == 0.5);
  CHECK(voxel({"--voxel", "0.5mm", "--units", "cm"}) == Approx(0.05).epsilon(1e-15));
  CHECK(voxel({"--voxel", "1%"}) == Approx(std::sqrt(1400.0) / 100).epsilon(1e-15));
  CHECK(voxel({"--voxel", "2e-1"}) == 0.2);
  CHECK(voxel({"--resolution", "60"}) == 0.5);
  CHECK(voxel({"--resolution", "60", "--band", "2.5mm", "--units", "mm"}) == 0.5);
}

TEST_CASE("the level set has the same bytes for 1, 2 and 7 threads") {
  const TemporaryFolder folder;
  write_text(folder / "ball.obj", ball_obj(40));
  std::string first;
  for (const char* threads : {"1", "2", "7"}) {
    REQUIRE(run_program({"convert", folder / "ball.obj", folder / "ball.vdb", "--threads", threads}).code ==
            0);
    const std::string bytes = content_of(folder / "ball.vdb");
    if (first.empty()) first = bytes;
    CHECK(bytes.size() > 100000);
    CHECK(bytes == first);
  }
}

TEST_CASE("conversion that needs more than --max-memory ends with 5 before it begins") {
  const TemporaryFolder folder;
  write_text(folder / "box.obj", box_obj(3, 2, 1));
  const RunResult result = run_program(
      {"convert", folder / "box.obj", folder / "box.vdb", "--resolution", "4096", "--max-memory", "64MiB"});
  CHECK(result.code == 5);
  CHECK_THAT(result.err, Catch::Contains("memory"));
  CHECK(folder.names() == std::vector<std::string>{"box.obj"});
}

TEST_CASE("voxels that OpenVDB cannot hold are refused before the work") {
  const TemporaryFolder folder;
  write_text(folder / "box.obj", box_obj(3e-3, 2e-3, 1e-3));
  const RunResult result =
      run_program({"convert", folder / "box.obj", folder / "box.vdb", "--resolution", "1000"});
  CHECK(result.code == 5);
  CHECK(result.out.empty()); // not even the plan
  CHECK_THAT(result.err, Catch::Contains("OpenVDB cannot represent voxels of 3e-06"));
  CHECK(folder.names() == std::vector<std::string>{"box.obj"});
}
