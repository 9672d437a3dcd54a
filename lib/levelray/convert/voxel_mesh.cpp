#include "levelray/convert/voxel_mesh.hpp"

#include "levelray/convert/caps.hpp"
#include "levelray/core/parallel.hpp"

#include <algorithm>
#include <cmath>

namespace levelray {

VoxelMesh make_voxel_mesh(const PreparedMesh& prepared, const GridTransform& transform) {
  const TriangleMesh& mesh = prepared.mesh;
  VoxelMesh out;
  out.vertices.resize(mesh.vertices.size());
  parallel_for(mesh.vertices.size(), 1 << 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) out.vertices[v] = transform.to_voxel(mesh.vertices[v]);
  });
  out.triangles = mesh.triangles;
  out.surface_count = mesh.triangles.size();
  out.boundary = prepared.open_edges;
  const std::vector<Triangle> caps = close_boundary(out.boundary);
  out.triangles.insert(out.triangles.end(), caps.begin(), caps.end());

  double largest = 1;
  for (const Vec3d& v : out.vertices)
    largest = std::max({largest, std::abs(v.x), std::abs(v.y), std::abs(v.z)});
  out.fraction_bits = std::clamp(VoxelMesh::max_extent_bits - 1 - std::ilogb(largest), 0, 20);
  const double scale = std::ldexp(1.0, out.fraction_bits);
  out.fixed.resize(out.vertices.size());
  parallel_for(out.vertices.size(), 1 << 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v)
      for (int axis = 0; axis < 3; ++axis)
        out.fixed[v][static_cast<std::size_t>(axis)] = std::llround(out.vertices[v][axis] * scale);
  });
  return out;
}

} // namespace levelray
