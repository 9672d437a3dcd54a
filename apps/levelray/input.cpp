#include "input.hpp"

#include "file_state.hpp"
#include "levelray/core/error.hpp"
#include "levelray/core/parallel.hpp"
#include "levelray/io/output_file.hpp"

#include <filesystem>
#include <fmt/format.h>
#include <fstream>

namespace levelray {

namespace {

// The flaws that --strict refuses, or "".
std::string flaws(const MeshReport& r) {
  std::string text;
  const auto add = [&](std::uint64_t n, const char* what) {
    if (n > 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", with_commas(n), what);
  };
  add(r.boundary_edges, "open edges");
  if (r.boundary_loops > 0)
    text += fmt::format(" in {} holes (largest {:.3g})", r.boundary_loops, r.longest_hole);
  add(r.non_manifold_edges, "non-manifold edges");
  add(r.winding_clashes, "edges between triangles of opposite orientation");
  add(r.duplicate_triangles + r.opposite_triangles, "duplicate triangles");
  return text;
}

// Tells voxels and the price of the conversion before it begins.
void announce(const InputOptions& input, const ConvertOptions& options, const ConvertPlan& plan) {
  const std::string by =
      options.voxel_size > 0 ? "" : fmt::format(" (longest side = {})", options.resolution);
  const std::string unit = input.units.empty() ? "" : " " + input.units;
  print(fmt::format("voxel {:.4g}{}{}, grid {} x {} x {}, band {:.4g} voxels; needs about {} and {}\n",
                    plan.voxel_size, unit, by, plan.dims.x, plan.dims.y, plan.dims.z,
                    options.half_width_voxels, bytes_text(plan.bytes),
                    duration_text(plan.seconds / thread_count())));
}

} // namespace

bool is_vdb(const std::string& path) {
  if (extension_of(path) == ".vdb") return true;
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) return false; // to look into a pipe is to wait for it
  // OpenVDB's magic number, a 64-bit little-endian integer (openvdb/version.h, OPENVDB_MAGIC).
  char first[8] = {};
  std::ifstream file(path, std::ios::binary);
  return file.read(first, 8) && std::string_view(first, 8) == std::string_view(" BDV\0\0\0\0", 8);
}

LoadedMesh load_mesh(const InputOptions& options, bool sheet) {
  const Stopwatch watch;
  LoadedMesh loaded;
  PrepareOptions prepare;
  prepare.trust_orientation = options.trust_orientation;
  prepare.sheet = sheet;
  const WatchedFile watched(options.path);
  MeshFile file = read_mesh(options.path, options.mesh_options());
  watched.check();
  try {
    loaded.prepared = prepare_mesh(file.mesh, prepare);
  } catch (const Error& error) { // says what is wrong, but does not know the file's name
    throw Error(error.kind(), printable(options.path, 300) + ": " + error.what());
  }
  loaded.format = file.format;
  loaded.warnings = std::move(file.warnings);
  if (!options.grid.empty() || options.trust_input)
    loaded.warnings.push_back("--grid and --trust-input are for .vdb files: no effect on a mesh");
  const auto& more = loaded.prepared.warnings;
  loaded.warnings.insert(loaded.warnings.end(), more.begin(), more.end());
  loaded.read_ms = watch.ms();
  if (options.strict)
    if (const std::string text = flaws(loaded.prepared.report); !text.empty())
      throw Error(ErrorKind::bad_input, printable(options.path, 300) + ": --strict: " + text);
  return loaded;
}

LoadedGrid convert_mesh(const InputOptions& input, const ConversionOptions& conversion,
                        const CommonOptions& common, Progress& progress,
                        void (*check_plan)(const ConvertPlan&), const MeshConverter& convert) {
  conversion.check();
  parse_unit(input.units);
  LoadedMesh mesh = load_mesh(input, !conversion.thicken.empty());
  ConvertOptions options = conversion.resolve(mesh.prepared.report.bounds, input);
  ConvertedGrid converted;
  try {
    const auto tell_mesh = [&] {
      if (common.talks())
        print(fmt::format("{}: {}\n", printable(input.path, 300),
                          describe_mesh(mesh.prepared.report, input.units)));
    };
    if (!convert) {
      const ConvertPlan plan = plan_conversion(mesh.prepared, options);
      if (check_plan) check_plan(plan);
      tell_mesh();
      if (common.talks()) announce(input, options, plan);
    } else {
      tell_mesh();
    }

    std::string stage;
    std::mutex stage_mutex;
    const double triangles = static_cast<double>(mesh.prepared.mesh.triangles.size());
    options.progress = [&](const char* name, double done) {
      {
        const std::lock_guard lock(stage_mutex);
        if (stage != name) progress.begin(stage = name, triangles, " triangles");
      }
      progress.report(done);
    };
    converted = convert ? convert(mesh.prepared, options) : mesh_to_grid(mesh.prepared, options);
    progress.finish();
  } catch (const Error& error) {
    if (error.kind() == ErrorKind::usage ||
        std::string_view(error.what()).starts_with(printable(input.path, 200)))
      throw;
    throw Error(error.kind(), printable(input.path, 300) + ": " + error.what());
  }

  LoadedGrid loaded;
  loaded.grid = std::move(converted.grid);
  loaded.mesh = mesh.prepared.report;
  loaded.converted = std::move(converted.report);
  loaded.warnings = std::move(mesh.warnings);
  loaded.warnings.insert(loaded.warnings.end(), loaded.converted->warnings.begin(),
                         loaded.converted->warnings.end());
  loaded.read_ms = mesh.read_ms;
  if (conversion.redistance != "auto" || !conversion.iso.empty())
    loaded.warnings.push_back("--redistance and --iso are for .vdb files: no effect on a mesh");
  if (!common.keep_warnings)
    for (const std::string& warning : loaded.warnings) print_warning(warning);
  if (const double thickness = loaded.converted->thickness; common.talks() && thickness > 0)
    print(fmt::format("sheet: {:.4g}{} thick ({:.3g} voxels), half of it on each side of the mesh\n",
                      thickness, input.units.empty() ? "" : " " + input.units,
                      thickness / loaded.grid.transform.voxel_size));
  else if (common.talks())
    print(fmt::format("sign: {} ({})\n",
                      sign_method_names()[static_cast<std::size_t>(loaded.converted->sign)],
                      loaded.converted->sign_reason));
  return loaded;
}

LoadedGrid load_grid(const InputOptions& input, const ConversionOptions& conversion,
                     const CommonOptions& common, Progress& progress) {
  if (!is_vdb(input.path)) return convert_mesh(input, conversion, common, progress);
  const Stopwatch watch;
  const WatchedFile watched(input.path);
  VdbFile file = read_vdb(input.path, conversion.vdb_options(input));
  watched.check();
  LoadedGrid loaded;
  loaded.redistanced = file.redistanced;
  loaded.grid = std::move(file.grid);
  loaded.warnings = std::move(file.warnings);
  loaded.read_ms = watch.ms();
  if (conversion.given_for_meshes() || (conversion.band != "3vx" && !loaded.redistanced))
    loaded.warnings.push_back(
        "--resolution, --voxel, --band, --sign and --thicken are for meshes: no effect on a .vdb");
  if (!common.keep_warnings)
    for (const std::string& warning : loaded.warnings) print_warning(warning);
  if (common.talks())
    print(fmt::format("{}: grid \"{}\", {} active samples, voxel {:.4g}, band {:.3g} voxels\n",
                      printable(input.path, 300), printable(loaded.grid.name, 100),
                      with_commas(loaded.grid.active_sample_count()), loaded.grid.transform.voxel_size,
                      loaded.grid.half_width_voxels()));
  if (const auto& r = loaded.redistanced; r && r->before.is_distance() && common.talks())
    print(fmt::format(
        "redistanced: {} surface cells; the surface moved by {:.2g} voxel (rms; at most {:.2g}); median "
        "gradient {:.2f}, was {:.2f}\n",
        with_commas(r->surface_cells), r->rms_moved_voxels, r->largest_moved_voxels, r->after.gradient_median,
        r->before.gradient_median));
  return loaded;
}

std::string describe_mesh(const MeshReport& r, const std::string& units) {
  const Vec3d size = r.bounds.isEmpty() ? Vec3d(0, 0, 0) : r.bounds.size();
  return fmt::format("{} vertices, {} triangles, {}, {}, {}; size {:.4g} x {:.4g} x {:.4g}{}",
                     with_commas(r.vertices), with_commas(r.triangles), r.closed ? "closed" : "open",
                     r.non_manifold_edges + r.non_manifold_vertices == 0 ? "manifold" : "not manifold",
                     orientation_name(r.orientation), size.x, size.y, size.z,
                     units.empty() ? "" : " " + units);
}

Json mesh_json(const MeshReport& r) {
  return {{"vertices", r.vertices},
          {"triangles", r.triangles},
          {"components", r.components},
          {"boundary_edges", r.boundary_edges},
          {"non_manifold_edges", r.non_manifold_edges},
          {"closed", r.closed},
          {"orientation", orientation_name(r.orientation)}};
}

Json grid_json(const BlockGrid& grid) {
  const Box3i bounds = grid.active_bounds();
  const Vec3i dims = bounds.isEmpty() ? Vec3i(0, 0, 0) : bounds.max - bounds.min + Vec3i(1, 1, 1);
  return {{"voxel_size", grid.transform.voxel_size},
          {"dims", {dims.x, dims.y, dims.z}},
          {"blocks", grid.block_count()},
          {"active_samples", grid.active_sample_count()},
          {"bytes", grid.bytes()}};
}

Json field_json(const FieldFacts& facts) {
  return {{"is_distance", facts.is_distance()},
          {"looks_like_voxel_units", facts.looks_like_voxel_units()},
          {"gradient",
           {{"median", facts.gradient_median}, {"p5", facts.gradient_low}, {"p95", facts.gradient_high}}},
          {"gradients_measured", facts.gradients},
          {"steep_share", facts.steep_share},
          {"crossings", facts.crossings}};
}

void add_field_facts(Json& json, const LoadedGrid& loaded) {
  if (loaded.converted && loaded.converted->thickness > 0)
    json["sheet"] = {{"thickness", loaded.converted->thickness},
                     {"voxels", loaded.converted->thickness / loaded.grid.transform.voxel_size}};
  if (const auto& r = loaded.redistanced)
    json["redistanced"] = {
        {"surface_cells", r->surface_cells},
        {"moved_voxels", {{"rms", r->rms_moved_voxels}, {"largest", r->largest_moved_voxels}}},
        {"before", field_json(r->before)},
        {"after", field_json(r->after)},
        {"ms", r->ms}};
}

void write_json(const CommonOptions& common, const Json& json) {
  if (common.json.empty()) return;
  // Texts from files may hold any bytes: what is no UTF-8 is replaced.
  const std::string text = json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
  if (common.json == "-")
    print(text);
  else
    write_file_atomically(common.json, text);
}

} // namespace levelray
