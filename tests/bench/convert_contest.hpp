// Mesh to narrow band: levelray's mesh_to_grid against OpenVDB's meshToLevelSet.
#pragma once

#include "bench/contest.hpp"
#include "levelray/mesh/triangle_mesh.hpp"

namespace levelray::bench {

struct ConvertSetup {
  int resolution = 256;
  double half_width_voxels = 3;
  int threads = 1;
  int repetitions = 7;
};

// Prints a table to standard output and returns it, or throws when the results are not those of one
// conversion: active samples in one grid only above 10^-3 of all
// (more below N = 256), or a difference above 0.01 voxel where our
// value is not the brute-force one.
nlohmann::json convert_contest(const TriangleMesh& mesh, const ConvertSetup& setup);

} // namespace levelray::bench
