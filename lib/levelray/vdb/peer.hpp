// OpenVDB's own tools on our data, for cross tests and benchmarks; OpenVDB's headers stay out of sight.
#pragma once

#include "levelray/core/ray.hpp"
#include "levelray/grid/block_grid.hpp"
#include "levelray/mesh/triangle_mesh.hpp"

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace levelray {

// What one call cost: wall clock and CPU time of all threads, of OpenVDB's work alone (without copies in and
// out).
struct PeerTime {
  double wall_ms = 0, cpu_ms = 0;
};

// What OpenVDB's tracer says of a ray.
struct PeerHit {
  bool hit = false;
  double t = 0;          // multiplies the ray's own direction
  Vec3d normal{0, 0, 0}; // world space, unit length, outward
};

// A level set in OpenVDB's hands. Each call does one thing and says what it cost, so that a benchmark can
// take turns between programs; calls use as many threads as ThreadLimit allows.
class OpenVdbLevelSet {
 public:
  // Converts with openvdb::tools::meshToLevelSet; OpenVDB takes positions as 32-bit floats. Samples lie at
  // origin + voxel_size * (i,j,k). Throws Error(failed) when OpenVDB does.
  static OpenVdbLevelSet from_mesh(const TriangleMesh& mesh, double voxel_size, double half_width_voxels,
                                   const Vec3d& origin = Vec3d(0, 0, 0), PeerTime* time = nullptr);
  // Takes over our values, bit by bit.
  static OpenVdbLevelSet from_grid(const BlockGrid& grid);
  // Reads the first grid of a file with openvdb::io::File, which must be of float type.
  static OpenVdbLevelSet from_file(const std::string& path);

  OpenVdbLevelSet(OpenVdbLevelSet&&) noexcept;
  OpenVdbLevelSet& operator=(OpenVdbLevelSet&&) noexcept;
  ~OpenVdbLevelSet();

  // Our copy of the values, with `cells`. Throws Error(bad_input) when there is no inside.
  BlockGrid to_grid() const;

  // openvdb::tools::checkLevelSet: empty when all is well, else its complaint. Checks 1 … `checks` of its
  // list; the last, 9, wants unit gradients, which a true distance lacks on its medial axis.
  std::string check(int checks = 9) const;

  // Traces with openvdb::tools::LevelSetRayIntersector, a copy of it for each 1024 rays, by the overload that
  // returns position, normal and time (the one for time alone returns the previous ray's in OpenVDB 10).
  // `hits` must hold rays.size() entries.
  PeerTime trace(const std::vector<WorldRay>& rays, std::vector<PeerHit>& hits) const;

  std::size_t bytes() const; // OpenVDB's count of the tree's memory
  std::size_t active_sample_count() const;

 private:
  struct Impl;
  explicit OpenVdbLevelSet(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

} // namespace levelray
