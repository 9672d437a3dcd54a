// Wrong usage: exit 2, one line on standard error, nothing on standard output, no file.
#include "support/catch.hpp"
#include "support/mesh_files.hpp"
#include "support/run_program.hpp"
#include "support/temporary_folder.hpp"

#include <algorithm>

using namespace levelray::test;

namespace {

struct Row {
  std::vector<std::string> arguments;
  std::string says;
};

} // namespace

TEST_CASE("wrong usage ends with 2 and one line that says what is legal") {
  const TemporaryFolder folder;
  const std::string mesh = folder / "box.obj", vdb = folder / "out.vdb", png = folder / "out.png";
  write_text(mesh, box_obj(3, 2, 1));
  const std::vector<Row> rows{
      {{}, "convert, render, info, compare"},
      {{"covert", mesh, vdb}, "did you mean \"convert\""},
      {{"--nonsense"}, "--nonsense"},
      {{"convert"}, "IN"},
      {{"convert", mesh}, "OUT"},
      {{"convert", mesh, vdb, "more"}, "more"},
      {{"convert", mesh, vdb, "--voxl", "1"}, "did you mean \"--voxel\""},
      {{"convert", mesh, vdb, "--voxel"}, "--voxel"},
      {{"convert", mesh, vdb, "--voxel", "0"}, "must be > 0"},
      {{"convert", mesh, vdb, "--voxel", "-1"}, "must be > 0"},
      {{"convert", mesh, vdb, "--voxel", "nan"}, "--voxel"},
      {{"convert", mesh, vdb, "--voxel", "4"}, "larger than the mesh"},
      {{"convert", mesh, vdb, "--voxel", "1mm"}, "--units"},
      {{"convert", mesh, vdb, "--voxel", "2vx"}, "voxels"},
      {{"convert", mesh, vdb, "--voxel", "1km"}, "mm, cm, m, in"},
      {{"convert", mesh, vdb, "--units", "ft"}, "mm, cm, m or in"},
      {{"convert", mesh, vdb, "--voxel", "0.1", "--resolution", "10"}, "--resolution"},
      {{"convert", mesh, vdb, "--resolution", "0"}, "--resolution"},
      {{"convert", mesh, vdb, "--resolution", "1e3"},
       "--resolution 1e3: not a whole number from 1 to 1048576"},
      {{"convert", mesh, vdb, "--band", "0vx"}, "must be > 0"},
      {{"convert", mesh, vdb, "--sign", "parity"}, "pseudonormal, winding, winding-abs, flood, unsigned"},
      {{"convert", mesh, vdb, "--sign", "windng"}, "did you mean \"winding\""},
      {{"convert", mesh, vdb, "--max-memory", "much"}, "--max-memory"},
      {{"convert", mesh, vdb, "--threads", "-1"}, "--threads"},
      {{"convert", mesh, vdb, "--format", "gltf"}, "obj, ply, stl"},
      {{"convert", mesh, folder / "out.obj"}, ".vdb"},
      {{"convert", mesh, folder / "out"}, "extension"},
      {{"convert", mesh, folder / "no/such/out.vdb"}, "does not exist"},
      {{"convert", mesh, vdb, "--json", folder / "no/such/out.json"}, "does not exist"},
      {{"convert", mesh, vdb, "--json", mesh}, "is the input"},
      {{"render", mesh}, "--output"},
      {{"render", mesh, "-o", folder / "out.jpg"}, ".exr, .png"},
      {{"render", mesh, "-o", mesh}, ".exr, .png"},
      {{"render", mesh, "-o", png, "-o", png}, "twice"},
      {{"render", mesh, "-o", png, "--size", "512"}, "WxH"},
      {{"render", mesh, "-o", png, "--size", "0x5"}, "WxH"},
      {{"render", mesh, "-o", png, "--size", "1e9x5"}, "WxH"},
      {{"render", mesh, "-o", png, "--eye", "1,2"}, "x,y,z"},
      {{"render", mesh, "-o", png, "--eye", "1,2,3", "--target", "1,2,3"}, "coincide"},
      {{"render", mesh, "-o", png, "--up", "0,0,0"}, "--up"},
      {{"render", mesh, "-o", png, "--eye", "0,9,0", "--target", "0,0,0"}, "parallel"},
      {{"render", mesh, "-o", png, "--fov", "180"}, "--fov"},
      {{"render", mesh, "-o", png, "--fov", "nan"}, "--fov"},
      {{"render", mesh, "-o", png, "--light", "0,0,0"}, "direction"},
      {{"render", mesh, "-o", png, "--light", "1,1,1,-2"}, "intensity"},
      {{"render", mesh, "-o", png, "--samples", "5"}, "square"},
      {{"render", mesh, "-o", png, "--repeat", "0"}, "--repeat"},
      {{"render", mesh, "-o", png, "--aov", "depth"}, "Z, t, P, N, id, steps, tests"},
      {{"render", mesh, "-o", png, "--aov", "t,"}, "Z, t, P, N, id, steps, tests"},
      {{"render", mesh, "-o", png, "--intersector", "exakt"}, "did you mean \"exact\""},
      {{"render", mesh, "-o", png, "--normals", "flat"}, "analytic"},
      {{"render", mesh, "-o", png, "--shading", "toon"}, "lambert, phong"},
      {{"info"}, "IN"},
      {{"info", mesh, mesh}, "unexpected"},
  };
  for (const Row& row : rows) {
    std::string line;
    for (const std::string& argument : row.arguments) line += argument + " ";
    INFO(line);
    const RunResult result = run_program(row.arguments);
    CHECK(result.code == 2);
    CHECK(result.out.empty());
    CHECK_THAT(result.err, Catch::Contains(row.says));
    CHECK(result.err.size() <= 500);
    CHECK(std::count(result.err.begin(), result.err.end(), '\n') == 1);
    CHECK(folder.names() == std::vector<std::string>{"box.obj"});
  }
}

TEST_CASE("help begins with examples, on standard output") {
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{"--help"},
                                             {"convert", "--help"},
                                             {"render", "--help"},
                                             {"info", "-h"},
                                             {"compare", "--help"},
                                             {"farm", "--help"}}) {
    const RunResult result = run_program(arguments);
    CHECK(result.code == 0);
    CHECK(result.err.empty());
    CHECK_THAT(result.out, Catch::StartsWith("Examples:\n  levelray ") && Catch::Contains("Usage: levelray"));
  }
}

TEST_CASE("the version names the libraries beneath") {
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{"--version"}, {"convert", "--version"}}) {
    const RunResult result = run_program(arguments);
    CHECK(result.code == 0);
    CHECK_THAT(result.out, Catch::StartsWith("levelray ") && Catch::Contains("OpenVDB 10.") &&
                               Catch::Contains("OpenEXR 3.") && Catch::Contains("oneTBB 20"));
  }
}
