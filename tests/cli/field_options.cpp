// The options that say what a mesh or a field is taken for: --thicken.
#include "support/catch.hpp"
#include "support/mesh_files.hpp"
#include "support/read_output.hpp"
#include "support/run_program.hpp"
#include "support/temporary_folder.hpp"

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
  CHECK_THAT(result.err, Catch::Contains("--thicken 1vx for a thin sheet"));
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
