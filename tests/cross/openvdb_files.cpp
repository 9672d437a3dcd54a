// Files that other programs wrote: what each must give.
#include "levelray/core/error.hpp"
#include "levelray/vdb/vdb_file.hpp"
#include "support/catch.hpp"

#include <filesystem>

using namespace levelray;

namespace {

struct Case {
  const char* file;
  const char* grid;     // as VdbReadOptions::grid
  std::uint64_t active; // samples, as the file's own metadata or OpenVDB counts them; 0: must be refused
  double voxel_size;    // to 1e-6 of itself
  const char* says;     // part of a warning or of the error
};

const Case cases[] = {
    {"vdb/sphere_houdini_half_v222.vdb", "", 270638, 0.05, ""},
    {"vdb/cube_houdini_half_v222.vdb", "", 1452218, 0.05, ""},
    {"vdb/sphere_unnamed_blosc.vdb", "", 40404, 0.01, ""},
    {"vdb/sphere_unnamed_blosc.vdb", "[0]", 40404, 0.01, ""},
    {"vdb/smoke_fog_half_v222.vdb", "", 0, 0, "grid \"density\" is a fog volume"},
    {"vdb/torus_fog_bifrost.vdb", "", 0, 0, "grid \"voxel_fog_density\" is a fog volume"},
    {"vdb/points.vdb", "", 0, 0, "grid \"points\" holds points"},
    {"vdb/densityAndHeat_nonuniform.vdb", "", 0, 0, "non-uniform voxels, which are not supported: 0.703"},
    {"vdb/densityAndHeat_nonuniform.vdb", "heat", 0, 0, "grid \"heat\" has non-uniform voxels"},
    {"vdb/velocity_vec3s.vdb", "", 0, 0, "grid \"vel\" holds vec3s values"},
    {"vdb-derived/zeno_sphere.zip-classless.vdb", "", 40404, 0.01, "has no class"},
    {"vdb-derived/zeno_sphere.nocompression.vdb", "", 40404, 0.01, ""},
    {"vdb-derived/dsg_0050.phi-only.vdb", "", 18432, 0.678731, "background 0: taken as 5"},
    {"sequence/liquid_mantaflow_vdb/fluid_data_0041.vdb", "", 0, 0, "several grids could be meant"},
    {"sequence/liquid_mantaflow_vdb/fluid_data_0041.vdb", "phi", 18432, 0.678731, "are no distances"},
    {"sequence/liquid_mantaflow_vdb/fluid_data_0060.vdb", "phi", 18432, 0.678731, "are no distances"},
    {"sequence/liquid_mantaflow_vdb/fluid_data_0050.vdb", "phi_out", 0, 0,
     "has no surface: no value is negative"},
    {"sequence/liquid_mantaflow_vdb/fluid_data_0050.vdb", "velocity", 0, 0, "holds vec3s values"},
    {"sequence/smoke_usd_vdb/smoke_000001.vdb", "", 0, 0,
     "no level set: grid \"density\" has non-uniform voxels"},
    {"sequence/smoke_usd_vdb/smoke_000002.vdb", "", 0, 0, "grid \"density\" is a fog volume"},
    {"sequence/smoke_usd_vdb/smoke_000003.vdb", "", 0, 0, "grid \"density\" has non-uniform voxels"},
    {"hostile/not-a-vdb-path-text.vdb", "", 0, 0, "not an OpenVDB file"},
};

} // namespace

TEST_CASE("files of other programs are read, or turned down with the reason") {
  for (const Case& c : cases) {
    const std::string path = std::string(LEVELRAY_TESTDATA) + "/" + c.file;
    CAPTURE(c.file, c.grid);
    if (!std::filesystem::exists(path)) {
      WARN("skipped, not there: " << path);
      continue;
    }
    VdbReadOptions options;
    options.grid = c.grid;
    std::string said;
    try {
      const VdbFile file = read_vdb(path, options);
      for (const std::string& warning : file.warnings) said += warning + "\n";
      CAPTURE(said);
      CHECK(file.grid.active_sample_count() == c.active);
      CHECK(file.grid.transform.voxel_size == Approx(c.voxel_size).epsilon(1e-6));
      CHECK(file.warnings.empty() == (std::string(c.says).empty()));
    } catch (const Error& error) {
      said = error.what();
      CAPTURE(said);
      CHECK(error.kind() == ErrorKind::bad_input);
      CHECK(c.active == 0);
      CHECK(said.size() <= Error::max_length);
    }
    CAPTURE(said);
    CHECK(said.find(c.says) != std::string::npos);
  }
}

TEST_CASE("a file's list of grids comes from its metadata") {
  const std::string path =
      std::string(LEVELRAY_TESTDATA) + "/sequence/liquid_mantaflow_vdb/fluid_data_0041.vdb";
  if (!std::filesystem::exists(path)) {
    WARN("skipped, not there: " << path);
    return;
  }
  const std::vector<VdbGridInfo> grids = list_vdb(path);
  REQUIRE(grids.size() == 10);
  CHECK(grids[0].name == "velocity");
  CHECK(grids[0].type == "vec3s");
  CHECK(grids[0].note == "holds vec3s values; a level set holds float or double");
  CHECK(grids[8].name == "phi");
  CHECK(grids[8].grid_class == "level set");
  CHECK(grids[8].note.empty());
}
