// What a subcommand reads: a mesh and what became of it, or a level set.
#pragma once

#include "console.hpp"
#include "levelray/convert/mesh_to_grid.hpp"
#include "options.hpp"

#include <functional>
#include <optional>

namespace levelray {

// Measures from its construction.
class Stopwatch {
 public:
  double ms() const {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

struct LoadedMesh {
  std::string format;
  PreparedMesh prepared;
  std::vector<std::string> warnings;
  double read_ms = 0; // file to prepared mesh
};

// Reads and prepares a mesh; with --strict, throws Error(bad_input) for one that has flaws. `sheet`: it need
// not have an inside (PrepareOptions).
LoadedMesh load_mesh(const InputOptions& options, bool sheet = false);

struct LoadedGrid {
  BlockGrid grid;
  std::optional<MeshReport> mesh;              // when it was converted
  std::optional<ConvertReport> converted;      // when it was converted
  std::optional<RedistanceReport> redistanced; // when it was read and --redistance did that
  std::vector<std::string> warnings;
  double read_ms = 0;
};

// Whether the path is an OpenVDB file, by its extension or its first bytes.
bool is_vdb(const std::string& path);

// Converts a mesh, telling about it: what it is, what the conversion will take, how it was signed. Warnings
// are printed once the work has succeeded. `check_plan` may refuse the plan by an Error before any work.
// `convert` may do the conversion, and the telling of its plan, in mesh_to_grid's place.
using MeshConverter = std::function<ConvertedGrid(const PreparedMesh&, const ConvertOptions&)>;
LoadedGrid convert_mesh(const InputOptions& input, const ConversionOptions& conversion,
                        const CommonOptions& common, Progress& progress,
                        void (*check_plan)(const ConvertPlan&) = nullptr, const MeshConverter& convert = {});

// Reads a level set, or converts a mesh as above.
LoadedGrid load_grid(const InputOptions& input, const ConversionOptions& conversion,
                     const CommonOptions& common, Progress& progress);

// "435,545 vertices, 871,306 triangles, closed, manifold, outward; size 0.9 x 0.63 x 0.4"
std::string describe_mesh(const MeshReport& report, const std::string& units);

Json mesh_json(const MeshReport& report); // the `input` of convert
Json grid_json(const BlockGrid& grid);    // {voxel_size, dims, blocks, active_samples, bytes}

Json field_json(const FieldFacts& facts); // whether it is a distance, in numbers

// Adds what was done to make the field, when something was: `sheet` {thickness, voxels} of --thicken,
// `redistanced` {surface_cells, moved_voxels, before, after, ms}.
void add_field_facts(Json& json, const LoadedGrid& loaded);

// Writes to --json's file or standard output, if asked.
void write_json(const CommonOptions& common, const Json& json);

} // namespace levelray
