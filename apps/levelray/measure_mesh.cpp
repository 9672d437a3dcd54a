// `levelray measure IN`: the user's own mesh as a document, with the trade of error for time and memory.
#include "input.hpp"
#include "levelray/core/error.hpp"
#include "levelray/measure/mesh_suite.hpp"
#include "measure_document.hpp"
#include "measure_suites.hpp"
#include "measure_trade.hpp"

#include <cmath>
#include <fmt/format.h>

namespace levelray {

namespace {

MeshSuiteSettings settings_of(const MeasureOptions& options) {
  MeshSuiteSettings settings;
  if (!options.resolutions.empty())
    settings.resolutions = parse_counts("--resolution", options.resolutions, 8, 4096);
  settings.half_width_voxels = band_voxels(options);
  settings.points = options.rays;
  settings.seed = options.seed;
  settings.repetitions = options.repeat;
  settings.max_memory = options.input.memory_limit();
  return settings;
}

std::string place_text(const Vec3d& p) {
  return fmt::format("{:.5g},{:.5g},{:.5g}", p.x, p.y, p.z);
}

Json surface_table(const MeshSuiteResult& result) {
  Table table("surfaces", "Grid and mesh; distances in voxels",
              {{"resolution", "resolution"},
               {"voxel", "voxel", 4},
               {"zero_rms", "zero set to mesh rms"},
               {"zero_p99", "p99"},
               {"zero_max", "max"},
               {"zero_at", "at"},
               {"mesh_mean", "mesh to zero set mean"},
               {"mesh_p99", "p99"},
               {"mesh_max", "max"},
               {"mesh_at", "at"},
               {"signs", "signs"},
               {"wrong_signs", "wrong", 3, true},
               {"brackets", "brackets"},
               {"bracketed", "with an end"},
               {"unbracketed", "wrong", 3, true},
               {"thin", "thinner than 2 voxels"},
               {"megabytes", "MB"},
               {"convert_ms", "convert ms"}});
  for (std::size_t i = 0; i < result.surfaces.size(); ++i) {
    const SurfaceRow& r = result.surfaces[i];
    const double h = r.voxel_size;
    table.add({r.resolution, h, r.from_zero_set_rms / h, r.from_zero_set.p99 / h, r.from_zero_set.max / h,
               place_text(r.farthest), r.from_mesh.mean / h, r.from_mesh.p99 / h, r.from_mesh.max / h,
               place_text(r.most_off), r.signs, r.wrong_signs, r.brackets, r.bracketed, r.unbracketed,
               fmt::format("{:.2f} %", 100 * result.thickness.thin_share[i]), r.megabytes, r.convert_ms});
  }
  return table.json();
}

} // namespace

void measure_mesh(const MeasureOptions& options, Progress& progress, Json& document) {
  const MeshSuiteSettings settings = settings_of(options);
  const LoadedMesh loaded = load_mesh(options.input);
  for (const std::string& warning : loaded.warnings) print_warning(warning);
  progress.begin("measuring", 0, "");
  MeshSuiteResult result;
  try {
    result = run_mesh_suite(loaded.prepared, settings, [&](double done) { progress.report(done); });
  } catch (const Error& error) { // knows the mesh, not the file
    throw Error(error.kind(), printable(options.input.path, 300) + ": " + error.what());
  }

  document["title"] = "levelray measure: " + printable(options.input.path, 200);
  document["options"] = {{"input", options.input.json()},
                         {"resolution", settings.resolutions},
                         {"band_voxels", settings.half_width_voxels},
                         {"rays", settings.points},
                         {"seed", settings.seed},
                         {"repeat", settings.repetitions}};
  document["mesh"] = mesh_json(loaded.prepared.report);
  const Thickness& thick = result.thickness;
  document["thickness"] = thickness_json(thick);

  Json& findings = document["findings"];
  for (const SurfaceRow& row : result.surfaces)
    if (row.wrong_signs)
      findings.push_back(
          fmt::format("at {}: {} of {} places have another sign than the mesh's winding number",
                      row.resolution, with_commas(row.wrong_signs), with_commas(row.signs)));
  for (const SurfaceRow& row : result.surfaces)
    if (row.unbracketed)
      document["failures"].push_back(
          fmt::format("at {}: {} of {} rays meet the mesh first where the grid proves that they do not",
                      row.resolution, with_commas(row.unbracketed), with_commas(row.brackets)));
  for (std::size_t i = 0; i < result.surfaces.size(); ++i)
    if (thick.thin_share[i] > 0.01)
      findings.push_back(fmt::format("at {}: {:.1f} % of the surface is thinner than 2 voxels",
                                     result.surfaces[i].resolution, 100 * thick.thin_share[i]));
  if (thick.points && thick.p1 > 0)
    findings.push_back(
        fmt::format("99 % of the surface is at least {:.4g} thick; --voxel {:.4g} gives that 2 voxels",
                    thick.p1, thick.p1 / 2));
  document["notes"] = {
      describe_mesh(loaded.prepared.report, options.input.units),
      "The zero set is where random rays meet the grid's surface, all of their crossings; its error is the "
      "distance "
      "from the mesh. The other way round it is the interpolant's size at points of the mesh, which is about "
      "their "
      "distance from the zero set, and large where a thin part is lost.",
      "Brackets: where along a ray the mesh must be met first, by the grid's samples and the most that "
      "interpolation can be off, 0.87 voxel; with an end where the hit is sure, too. Closed meshes only.",
      "Thickness is measured from points of the mesh against their normals to the next place of the mesh; it "
      "goes to "
      "0 towards convex edges. Signs are counted in closed meshes, more than a voxel from the surface.",
      "A configuration is in front where no other is better in one of mean error, lost rays, time and memory "
      "and at "
      "least as good in the others. Lost: leaks, phantoms and wrong surfaces against the grid's own surface. "
      "Normals "
      "are compared with the nearest face's, so that facets of curved surfaces count as they are."};
  document["sections"].push_back(
      trade_section(result.trade, {"distances of hits from the mesh", "degrees to the face's normal"}));
  document["sections"].push_back({{"id", "surface"},
                                  {"title", "Surface"},
                                  {"text", "How far the grid's surface and the mesh are from each other."},
                                  {"plots", Json::array()},
                                  {"tables", {surface_table(result)}}});
}

} // namespace levelray
