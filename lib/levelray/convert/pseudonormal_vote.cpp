#include "levelray/convert/pseudonormal_vote.hpp"

#include "levelray/grid/coords.hpp"

#include <bit>
#include <limits>

namespace levelray {

std::int32_t pseudonormal_vote(const VoxelMesh& mesh, const Pseudonormals& pseudonormals,
                               std::span<const std::uint32_t> candidates, const Vec3i& first_sample,
                               const float* distance, std::uint64_t samples, float half_width) {
  int speaker = -1, voters = 0;
  for (std::uint64_t rest = samples; rest; rest &= rest - 1) {
    const int s = std::countr_zero(rest);
    if (!(distance[s] < half_width)) continue;
    ++voters;
    if (speaker < 0 || distance[s] > distance[speaker]) speaker = s;
  }
  if (speaker < 0) return 0;

  const Vec3i sample = first_sample + Vec3i(bit_x(speaker), bit_y(speaker), bit_z(speaker));
  const Vec3d p(sample.x, sample.y, sample.z);
  TrianglePoint nearest;
  nearest.distance_squared = std::numeric_limits<double>::infinity();
  std::uint32_t triangle = 0;
  for (const std::uint32_t t : candidates) {
    if (mesh.is_cap(t)) continue;
    const Triangle& v = mesh.triangles[t];
    const TrianglePoint point =
        closest_point_on_triangle(mesh.vertices[v[0]], mesh.vertices[v[1]], mesh.vertices[v[2]], p);
    if (point.distance_squared < nearest.distance_squared) {
      nearest = point;
      triangle = t;
    }
  }
  const double side = (p - nearest.point).dot(pseudonormals.at(triangle, nearest.feature));
  return side < 0 ? voters : side > 0 ? -voters : 0;
}

} // namespace levelray
