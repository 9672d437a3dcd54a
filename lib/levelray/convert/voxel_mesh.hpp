// The mesh as the conversion sees it: in voxel space, in double and in fixed point, with its holes capped for
// counting.
#pragma once

#include "levelray/grid/coords.hpp"
#include "levelray/mesh/prepare.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace levelray {

// A position in units of 2^-fraction_bits voxel. Signs are decided on these integers, exactly.
using FixedPoint = std::array<std::int64_t, 3>;

// Triangles 0 .. surface_count-1 are the mesh's; those after it are caps (caps.hpp), which close the mesh's
// boundary chain. The winding number of mesh and caps together is an integer everywhere off the triangles;
// caps never count for distances.
struct VoxelMesh {
  // Differences of coordinates stay below 2^39, so that crossing.cpp's determinants stay below 2^127.
  static constexpr int max_extent_bits = 38;

  std::vector<Vec3d> vertices; // voxel units
  std::vector<FixedPoint>
      fixed; // the same, rounded to 2^-fraction_bits (an error of at most 2^-21 voxel up to 2^18 voxels)
  std::vector<Triangle> triangles;
  std::vector<std::array<std::uint32_t, 2>> boundary; // the caps' oriented boundary: PreparedMesh::open_edges
  std::size_t surface_count = 0;
  int fraction_bits = 20;

  bool is_cap(std::size_t triangle) const { return triangle >= surface_count; }
  bool has_caps() const { return triangles.size() > surface_count; }
};

// `transform` must place the mesh within +-2^30 voxels of index 0.
VoxelMesh make_voxel_mesh(const PreparedMesh& mesh, const GridTransform& transform);

} // namespace levelray
