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
    print(fmt::format("{}: {}\n", input.path, describe_mesh(r, input.units)));
    print(fmt::format("{} components, {} shells, volume {:.6g}\n", with_commas(r.components),
                      with_commas(r.shells), r.volume));
    if (r.boundary_edges > 0)
      print(fmt::format("{} open edges in {} holes, the largest {:.4g} across\n",
                        with_commas(r.boundary_edges), with_commas(r.boundary_loops), r.longest_hole));
    if (r.non_manifold_edges + r.non_manifold_vertices > 0)
      print(fmt::format("{} non-manifold edges, {} non-manifold vertices\n",
                        with_commas(r.non_manifold_edges), with_commas(r.non_manifold_vertices)));
    if (r.degenerate_triangles + r.duplicate_triangles + r.opposite_triangles + r.winding_clashes > 0)
      print(fmt::format(
          "{} degenerate, {} duplicate, {} opposite triangles; {} edges of clashing orientation\n",
          with_commas(r.degenerate_triangles), with_commas(r.duplicate_triangles),
          with_commas(r.opposite_triangles), with_commas(r.winding_clashes)));
    if (r.merged_vertices + r.unreferenced_vertices > 0)
      print(fmt::format("{} vertices at the place of another, {} used by no triangle\n",
                        with_commas(r.merged_vertices), with_commas(r.unreferenced_vertices)));
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
  if (common.talks()) print(fmt::format("{}: {} grids\n", input.path, grids.size()));
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
    if (!info.note.empty()) {
      if (common.talks()) print(fmt::format("{}: {}\n", title, printable(info.note, 300)));
    } else {
      VdbReadOptions one = input.vdb_options();
      one.grid = fmt::format("[{}]", i);
      const VdbFile file = read_vdb(input.path, one);
      warnings.insert(warnings.end(), file.warnings.begin(), file.warnings.end());
      const BlockGrid& grid = file.grid;
      const GridTransform& transform = grid.transform;
      const Box3i box = grid.active_bounds();
      const Json details = grid_json(grid);
      entry["background"] = grid.background;
      entry["half_width_voxels"] = grid.half_width_voxels();
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
