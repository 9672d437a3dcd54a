// A level set against the mesh that it was made of, and what methods make of it: the trade of error for time
// and memory.
#pragma once

#include "levelray/grid/block_grid.hpp"
#include "levelray/measure/error_statistics.hpp"
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
};

// The mesh's own thickness: from points of it against their normals to the next place of the mesh. Towards
// convex edges it goes to 0, so small quantiles say more than the minimum. Likewise gaps, along the normals.
struct Thickness {
  std::size_t points = 0, gaps = 0;        // with something there
  double p01 = 0, p1 = 0, p5 = 0, p50 = 0; // quantiles 0.1 %, 1 %, ... of thicknesses, world units
  double gap_p1 = 0, gap_p50 = 0;
  std::vector<double> thin_share; // per resolution: part of the points thinner than 2 voxels
};

// One configuration: a resolution with an intersector, or with a normal scheme.
struct TradeRow {
  int resolution = 0;
  std::string method;
  bool is_normals = false;
  ErrorStatistics error;  // of hits: distance from the mesh in world units; of normals: degrees to the face's
  std::uint64_t lost = 0; // leaks, phantoms and wrong surfaces against the grid's own surface, of all rays
  double ns = 0, megabytes = 0; // per random ray, or per hit
  bool in_front = false; // no other of its kind is better in one of error (mean), losses, time, memory and
                         // at least as good in the others
};

struct MeshSuiteResult {
  std::vector<SurfaceRow> surfaces;
  Thickness thickness;
  std::vector<TradeRow> trade;
};

// Throws what mesh_to_grid throws.
MeshSuiteResult run_mesh_suite(
    const PreparedMesh& mesh, const MeshSuiteSettings& settings,
    const std::function<void(double)>& progress = [](double) {});

} // namespace levelray
