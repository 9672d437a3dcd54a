#include "mesh_frames.hpp"

#include "levelray/core/error.hpp"
#include "levelray/io/output_file.hpp"

#include <algorithm>

namespace levelray {

namespace {

struct LoadedMeshGrid : LoadedFrame {
  LoadedGrid file;
};

void check_plan(const ConvertPlan& plan) {
  check_vdb_voxel_size(plan.voxel_size);
}

} // namespace

std::string MeshFrames::settings(int) const {
  Json json = input_.lasting_json();
  json.update(conversion_.json());
  json["half"] = write_.half;
  return json.dump();
}

std::shared_ptr<const LoadedFrame> MeshFrames::load(const std::vector<std::string>& paths,
                                                    std::uint64_t memory, double seconds) const {
  const InputOptions input = input_.of_frame(paths.front(), memory, seconds);
  const CommonOptions silent = CommonOptions::silent();
  Progress none(true);
  auto loaded = std::make_shared<LoadedMeshGrid>();
  loaded->file = is_vdb(input.path) ? load_grid(input, conversion_, silent, none)
                                    : convert_mesh(input, conversion_, silent, none, check_plan);
  loaded->bytes = loaded->file.grid.bytes();
  loaded->warnings = loaded->file.warnings;
  return loaded;
}

MadeFrame MeshFrames::make(int, std::shared_ptr<const LoadedFrame> loaded,
                           const std::vector<std::string>& outputs,
                           const std::function<void(double)>&) const {
  const auto mesh = std::static_pointer_cast<const LoadedMeshGrid>(loaded);
  MadeFrame made;
  made.bytes = 2 * mesh->bytes; // the grid is held until OpenVDB's copy of it is written
  made.facts = {{"grid", grid_json(mesh->file.grid)}, {"ms", {{"read", mesh->file.read_ms}}}};
  if (const auto& report = mesh->file.converted) {
    made.facts["sign"] = sign_method_names()[static_cast<std::size_t>(report->sign)];
    made.facts["ms"]["distance"] = report->distance_ms;
    made.facts["ms"]["sign"] = report->sign_ms;
  }
  add_field_facts(made.facts, mesh->file);
  made.write = [mesh, outputs, options = write_](const std::string& scene_hash) {
    VdbWriteOptions stamped = options;
    stamped.scene_hash = scene_hash;
    for (const std::string& output : outputs)
      write_file_atomically(output,
                            [&](const std::string& path) { write_vdb(path, mesh->file.grid, stamped); });
  };
  return made;
}

} // namespace levelray
