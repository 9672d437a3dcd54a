// levelray info: what is in a file, and whether it is fit for conversion or tracing.
#include "commands.hpp"
#include "input.hpp"
#include "levelray/core/error.hpp"
#include "levelray/core/parallel.hpp"

#include <fmt/format.h>
#include <memory>

namespace levelray {

namespace {

struct Info {
  CommonOptions common;
  InputOptions input;

  void run() const;
  Json mesh_info() const;
  Json vdb_info() const;
};

Json box_json(const Vec3d& low, const Vec3d& high) {
  return {{"min", {low.x, low.y, low.z}}, {"max", {high.x, high.y, high.z}}};
}

Json Info::mesh_info() const {
  const LoadedMesh mesh = load_mesh(input);
  const MeshReport& r = mesh.prepared.report;
  for (const std::string& warning : mesh.warnings) print_warning(warning);
  if (common.talks()) {
    print(fmt::format("{}: {}\n", printable(input.path, 300), describe_mesh(r, input.units)));
    const std::string unit = input.units.empty() ? "" : " " + input.units;
    print(fmt::format("{}, {}, volume {:.6g}{}\n", counted(r.components, "component", "components"),
                      counted(r.shells, "shell", "shells"), r.volume, unit.empty() ? "" : unit + "^3"));
    if (r.boundary_edges > 0)
      print(fmt::format("{} in {}, the largest {:.4g}{} across\n",
                        counted(r.boundary_edges, "open edge", "open edges"),
                        counted(r.boundary_loops, "hole", "holes"), r.longest_hole, unit));
    if (r.non_manifold_edges + r.non_manifold_vertices > 0)
      print(fmt::format("{}, {}\n", counted(r.non_manifold_edges, "non-manifold edge", "non-manifold edges"),
                        counted(r.non_manifold_vertices, "non-manifold vertex", "non-manifold vertices")));
    if (r.degenerate_triangles + r.duplicate_triangles + r.opposite_triangles + r.winding_clashes > 0)
      print(fmt::format(
          "{} degenerate, {} duplicate, {} opposite triangles; {} edges of clashing orientation\n",
          with_commas(r.degenerate_triangles), with_commas(r.duplicate_triangles),
          with_commas(r.opposite_triangles), with_commas(r.winding_clashes)));
    if (r.merged_vertices + r.unreferenced_vertices > 0)
      print(fmt::format("{} at the place of another, {} used by no triangle\n",
                        counted(r.merged_vertices, "vertex", "vertices"),
                        with_commas(r.unreferenced_vertices)));
  }
  Json facts = mesh_json(r);
  facts["shells"] = r.shells;
  facts["boundary_loops"] = r.boundary_loops;
  facts["longest_hole"] = r.longest_hole;
  facts["non_manifold_vertices"] = r.non_manifold_vertices;
  facts["winding_clashes"] = r.winding_clashes;
  facts["degenerate_triangles"] = r.degenerate_triangles;
  facts["duplicate_triangles"] = r.duplicate_triangles;
  facts["opposite_triangles"] = r.opposite_triangles;
  facts["merged_vertices"] = r.merged_vertices;
  facts["unreferenced_vertices"] = r.unreferenced_vertices;
  facts["bounds"] = box_json(r.bounds.min, r.bounds.max);
  facts["volume"] = r.volume;
  return {{"type", "mesh"}, {"format", mesh.format}, {"input", facts}, {"warnings", mesh.warnings}};
}

Json Info::vdb_info() const {
  const std::vector<VdbGridInfo> grids = list_vdb(input.path, input.vdb_options());
  if (common.talks())
    print(fmt::format("{}: {}\n", printable(input.path, 300), counted(grids.size(), "grid", "grids")));
  Json list = Json::array();
  std::vector<std::string> warnings;
  for (std::size_t i = 0; i < grids.size(); ++i) {
    const VdbGridInfo& info = grids[i];
    const std::string title = fmt::format("\"{}\": {}, class {}", printable(info.name, 100),
                                          printable(info.type, 40), printable(info.grid_class, 40));
    Json entry = {{"name", info.name},
                  {"type", info.type},
                  {"class", info.grid_class},
                  {"active_samples", info.active_samples},
                  {"voxel_size", info.voxel_size},
                  {"traceable", info.note.empty()},
                  {"note", info.note}};
    VdbFile file;
    std::string note = info.note;
    if (note.empty()) {
      VdbReadOptions one = input.vdb_options();
      one.grid = fmt::format("[{}]", i);
      try {
        file = read_vdb(input.path, one);
      } catch (const Error& error) {
        // What is wrong with one grid's values is a fact about it; the others are still of interest.
        if (error.kind() != ErrorKind::bad_input || grids.size() == 1) throw;
        note = error.what();
        for (const std::string& known : {input.path + ": ", fmt::format("grid \"{}\" ", info.name)})
          if (note.starts_with(known)) note.erase(0, known.size());
        entry["traceable"] = false;
        entry["note"] = note;
      }
    }
    if (!note.empty()) {
      if (common.talks()) print(fmt::format("{}: {}\n", title, printable(note, 300)));
    } else {
      const std::string which =
          grids.size() > 1 ? fmt::format("grid \"{}\": ", printable(info.name, 100)) : "";
      for (const std::string& warning : file.warnings) warnings.push_back(which + warning);
      const BlockGrid& grid = file.grid;
      const GridTransform& transform = grid.transform;
      const Box3i box = grid.active_bounds();
      const Json details = grid_json(grid);
      entry["background"] = grid.background;
      entry["half_width_voxels"] = grid.half_width_voxels();
      entry["field"] = field_json(file.facts);
      entry["origin"] = {transform.origin.x, transform.origin.y, transform.origin.z};
      entry["index_bounds"] = box_json(Vec3d(box.min), Vec3d(box.max));
      entry["bounds"] = box_json(transform.to_world(Vec3d(box.min)), transform.to_world(Vec3d(box.max)));
      entry["dims"] = details["dims"];
      entry["blocks"] = details["blocks"];
      entry["bytes"] = details["bytes"];
      if (common.talks())
        print(fmt::format("{}: {} active samples, voxel {:.6g}, background {:.6g} (band {:.3g} voxels),\n"
                          "  samples {},{},{} to {},{},{}, sample 0,0,0 at {:.6g},{:.6g},{:.6g}\n",
                          title, with_commas(info.active_samples), transform.voxel_size, grid.background,
                          grid.half_width_voxels(), box.min.x, box.min.y, box.min.z, box.max.x, box.max.y,
                          box.max.z, transform.origin.x, transform.origin.y, transform.origin.z));
    }
    list.push_back(entry);
  }
  for (const std::string& warning : warnings) print_warning(warning);
  if (common.talks())
    print("Samples are the corners of cells (vertex-centred): each is the value at its own point.\n");
  return {{"type", "vdb"}, {"sampling", "vertex-centred"}, {"grids", list}, {"warnings", warnings}};
}

void Info::run() const {
  std::vector<std::string> outputs;
  if (!common.json.empty() && common.json != "-") check_output(common.json, input.path, {}, outputs);
  const ThreadLimit threads(common.threads);
  write_json(common, is_vdb(input.path) ? vdb_info() : mesh_info());
}

} // namespace

void add_info(CLI::App& program, Work& run) {
  auto options = std::make_shared<Info>();
  CLI::App& command = *program.add_subcommand("info", "Tell what is in a mesh or a .vdb");
  command.footer(R"(Examples:
  levelray info statue.ply
  levelray info clouds.vdb
  levelray info statue.ply --strict --json - | jq .input.closed

Tells what is in a mesh (is it closed? which way round? how many holes?) or in a .vdb (which grids, of which class,
with which band).)");
  command
      .add_option("IN", options->input.path, "A mesh or a .vdb; -: a mesh on standard input (needs --format)")
      ->required();
  options->input.add_to(command);
  options->common.add_to(command);
  command.callback([options, &run] { run = [options] { options->run(); }; });
}

} // namespace levelray
