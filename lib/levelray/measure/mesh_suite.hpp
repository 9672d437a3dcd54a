// A level set against the mesh that it was made of, and what methods make of it: the trade of error for time
// and memory.
#pragma once

#include "levelray/grid/block_grid.hpp"
#include "levelray/measure/error_statistics.hpp"
#include "levelray/measure/thickness.hpp"
#include "levelray/measure/trade.hpp"
#include "levelray/mesh/prepare.hpp"

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace levelray {

struct MeshSuiteSettings {
  std::vector<int> resolutions{64, 128, 256}; // voxels along the longest side of the mesh
  double half_width_voxels = 3;
  std::size_t points = 8192; // on the mesh, and as many random rays
  std::uint64_t seed = 1;
  int repetitions = 3;          // of timings; 0: none
  std::uint64_t max_memory = 0; // bytes, of a grid; 0: no limit
};

// How far the surface of a grid and the mesh are from each other. All in world units.
struct SurfaceRow {
  int resolution = 0;
  double voxel_size = 0, megabytes = 0, convert_ms = 0; // of the grid and what tracing adds
  ErrorStatistics from_zero_set; // the mesh's distance from places where random rays meet the grid's surface
  double from_zero_set_rms = 0;
  Vec3d farthest{0, 0, 0};   // of those places
  ErrorStatistics from_mesh; // |interpolant| at points of the mesh: about their distance from the zero set
  Vec3d most_off{0, 0, 0};   // of those points
  // Random places more than a voxel from the mesh whose sign is not that of the mesh's winding number
  // (counted by the crossings of a ray; inside where it is not 0), of all such places. Closed meshes only:
  // else 0 of 0.
  std::uint64_t wrong_signs = 0, signs = 0;
  // Random rays for which trace/certified_hit brackets the mesh by the grid's own error (`bracketed`, the
  // hits among them with an end behind), and those whose first place on the mesh is not in there: none.
  std::uint64_t brackets = 0, bracketed = 0, unbracketed = 0;
};

struct MeshSuiteResult {
  std::vector<SurfaceRow> surfaces;
  Thickness thickness; // of the mesh
  std::vector<TradeRow> trade;
};

// Throws what mesh_to_grid throws.
MeshSuiteResult run_mesh_suite(
    const PreparedMesh& mesh, const MeshSuiteSettings& settings,
    const std::function<void(double)>& progress = [](double) {});

} // namespace levelray
