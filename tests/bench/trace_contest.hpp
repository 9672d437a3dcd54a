// Primary rays: levelray against OpenVDB's LevelSetRayIntersector on the same grid, and Embree on the mesh.
#pragma once

#include "bench/contest.hpp"
#include "levelray/mesh/triangle_mesh.hpp"

#include <string>

namespace levelray::bench {

struct TraceSetup {
  int resolution = 256;
  int image_size = 512;
  int threads = 1;
  int repetitions = 7;
  std::string intersector = "exact";
  std::string normals = "interpolation-of-differences";
  bool embree = true; // where it was found when this was built
};

// Each contestant traces the same rays (levelray/measure/study_scene.hpp) and writes t and normal of every
// hit. Prints a table to standard output and returns it, or throws when the answers are not those of one
// surface: levelray and OpenVDB disagree about more than 10^-3 of the rays, or half of their common hits lie
// more than 0.01 voxel apart, or more than one in a hundred more than 0.5 voxel.
nlohmann::json trace_contest(const TriangleMesh& mesh, const TraceSetup& setup);

// Whether Embree can take part.
bool has_embree();

} // namespace levelray::bench
