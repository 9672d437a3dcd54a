// Sequences that simulations wrote: every frame becomes a level set and a picture.
#include "levelray/convert/mesh_to_grid.hpp"
#include "levelray/convert/thicken.hpp"
#include "levelray/core/error.hpp"
#include "levelray/io/mesh_reader.hpp"
#include "levelray/render/render_image.hpp"
#include "levelray/render/surface_extent.hpp"
#include "levelray/vdb/vdb_file.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <filesystem>
#include <set>

using namespace levelray;

namespace {

// The files of a sequence, in order; empty, with a warning, where it is not there.
std::vector<std::string> frames(const std::string& name, const std::string& extension) {
  const std::filesystem::path folder = std::filesystem::path(LEVELRAY_TESTDATA) / "sequence" / name;
  std::vector<std::string> files;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored))
    if (entry.path().extension() == extension) files.push_back(entry.path().string());
  std::sort(files.begin(), files.end());
  if (files.empty()) WARN("not tested: no frames in " << folder.string());
  return files;
}

// The share of a small picture that the surface covers, seen along a diagonal.
double covered(const BlockGrid& grid) {
  RenderOptions options;
  options.camera.width = options.camera.height = 48;
  const Box3i samples = grid.active_bounds();
  const Vec3d low = grid.transform.to_world(Vec3d(samples.min)),
              high = grid.transform.to_world(Vec3d(samples.max));
  options.camera.target = (low + high) / 2;
  options.camera.eye = options.camera.target + Vec3d(0.6, 0.5, 0.8) * ((high - low).length() * 1.5);
  options.shadows = true;
  options.normals = "interpolation-of-differences";
  const RenderedImage rendered = render_image(grid, options);
  return static_cast<double>(rendered.stats.hits) / (48.0 * 48.0);
}

} // namespace

TEST_CASE("each frame of cloth and flag becomes a sheet, exact and without holes") {
  struct Sequence {
    const char *name, *extension;
    std::size_t count;
    bool same_topology;
  };
  for (const Sequence& s :
       {Sequence{"cloth_obj", ".obj", 20, true}, Sequence{"flag_remeshed_ply", ".ply", 12, false}}) {
    const std::vector<std::string> files = frames(s.name, s.extension);
    if (files.empty()) continue;
    CHECK(files.size() == s.count);
    std::set<std::uint64_t> triangles;
    for (const std::string& file : files) {
      CAPTURE(file);
      const PreparedMesh mesh = prepare_mesh(read_mesh(file).mesh);
      triangles.insert(mesh.report.triangles);
      CHECK(!mesh.report.closed);
      ConvertOptions options;
      options.resolution = 96;
      options.thicken = plan_conversion(mesh, options).voxel_size; // a sheet of two voxels
      const ConvertedGrid converted = mesh_to_grid(mesh, options);
      CHECK(converted.report.thickness == 2 * options.thicken);
      CHECK(converted.report.warnings.empty());
      // The middle of the sheet, the mesh itself, is inside throughout: at the samples next to each vertex.
      std::uint64_t holes = 0;
      for (const Vec3d& v : mesh.mesh.vertices) {
        const Vec3d p = converted.grid.transform.to_voxel(v);
        // The nearest sample is within sqrt(3)/2 of a voxel, less than the radius.
        holes +=
            !(converted.grid.value(static_cast<int>(std::lround(p.x)), static_cast<int>(std::lround(p.y)),
                                   static_cast<int>(std::lround(p.z))) < 0);
      }
      CHECK(holes == 0);
      CHECK(covered(converted.grid) > 0.02);
    }
    CHECK((triangles.size() == 1) == s.same_topology);
  }
}

TEST_CASE("each frame of Mantaflow's liquid is detected, redistanced and rendered") {
  const std::vector<std::string> files = frames("liquid_mantaflow_vdb", ".vdb");
  if (files.empty()) return;
  CHECK(files.size() == 20);
  for (const std::string& file : files) {
    CAPTURE(file);
    VdbReadOptions options;
    options.grid = "phi";
    options.redistance = Redistance::automatic;
    const VdbFile read = read_vdb(file, options);
    REQUIRE(read.redistanced);
    CHECK(read.facts.looks_like_voxel_units());
    const RedistanceReport& report = *read.redistanced;
    CHECK(!report.before.is_distance());
    CHECK(report.after.gradient_median == Approx(1).margin(0.05));
    CHECK(report.after.steep_share == 0);
    CHECK(report.rms_moved_voxels < 0.06);    // measured: 0.037 to 0.053
    CHECK(report.largest_moved_voxels < 0.3); // measured: 0.208 to 0.235
    CHECK(read.grid.half_width_voxels() == Approx(3).epsilon(1e-6));
    CHECK(read.grid.active_sample_count() < 18432); // the dense grid is a narrow band now
    const auto told =
        std::count_if(read.warnings.begin(), read.warnings.end(), [](const std::string& warning) {
          return warning.find("near ones in voxels") != std::string::npos &&
                 warning.find("redistanced, which moved the surface by 0.") != std::string::npos;
        });
    CHECK(told == 1);
    CHECK(covered(read.grid) > 0.02);

    options.redistance = Redistance::never;
    const VdbFile raw = read_vdb(file, options);
    CHECK(!raw.redistanced);
    std::uint64_t flipped = 0;
    for (int k = -1; k <= 32; ++k)
      for (int j = -1; j <= 24; ++j)
        for (int i = -1; i <= 24; ++i)
          flipped += (raw.grid.value(i, j, k) < 0) != (read.grid.value(i, j, k) < 0);
    CHECK(flipped == 0);
  }
}

TEST_CASE("frames without a surface are turned down: smoke and particles") {
  for (const std::string& file : frames("smoke_usd_vdb", ".vdb")) {
    CAPTURE(file);
    VdbReadOptions options;
    options.redistance = Redistance::always;
    CHECK_THROWS_AS(read_vdb(file, options), Error);
  }
  for (const std::string& file : frames("particles_splashsurf", ".vtk")) {
    CAPTURE(file);
    CHECK_THROWS_AS(read_mesh(file), Error);
  }
}
