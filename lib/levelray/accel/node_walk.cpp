#include "levelray/accel/node_walk.hpp"

#include "levelray/accel/visited_cell.hpp"

#include <cassert>

namespace levelray {

namespace walk {

bool NodeExit::settle(const RayFrame& ray, const NodeTable& table, int length, const int (&next)[3],
                      int (&at)[3]) const {
  bool before = true; // axes before the crossed one: planes that are crossed now come first
  for (int a = 0; a < 3; ++a) {
    const int first = at[a], last = std::min(at[a] + length, table.dims[a]) - 1;
    at[a] = next[a];
    if (crossed[a]) {
      before = false;
      continue;
    }
    const auto is_crossed = [&](int plane) {
      const double time = plane_time(ray, a, plane * double{node_dim});
      return time < s || (before && time == s);
    };
    while (at[a] > first && !is_crossed(at[a])) --at[a];
    while (at[a] < last && is_crossed(at[a] + 1)) ++at[a];
  }
  return table.has(at[0], at[1], at[2]);
}

} // namespace walk

namespace {

// Moves the walk's beginning and end to s in [start, last].
bool cut(const SurfaceBlocks& surface, RayFrame& ray, double start, double last) {
  if (last < ray.last) ray.last = last;
  if (start > ray.start) {
    if (!(start <= ray.last)) return false;
    // There is no surface within the margin, so it does not matter on which side of a plane rounding puts the
    // beginning: the walk goes on to the nodes behind it.
    const int dims[3] = {surface.node_dims().x, surface.node_dims().y, surface.node_dims().z};
    for (int a = 0; a < 3; ++a) {
      const int p = static_cast<int>((ray.origin[a] + start * ray.direction[a]) * (1.0 / node_dim));
      ray.start_node[a] = std::min(std::max(p, ray.start_node[a]), dims[a] - 1);
    }
    ray.start = start;
  }
  return ray.start <= ray.last;
}

} // namespace

bool narrow_frame(const SurfaceBlocks& surface, RayFrame& ray, double near, double far) {
  if (near > far) return false;
  // The frame's rounding is some 2^-50 of the distances in voxels (ray_frame.hpp), that of the subtractions
  // here 2^-52 of the times; 2^-12 voxel covers that of the box itself, which has 2^22 voxels at the most.
  const double per_t = 1 / ray.t_per_s;
  const auto margin = [&](double t) {
    return 0x1p-12 + 0x1p-44 * (std::fabs(t) + std::fabs(ray.t_at_start)) * per_t;
  };
  return cut(surface, ray, (near - ray.t_at_start) * per_t - margin(near),
             (far - ray.t_at_start) * per_t + margin(far));
}

bool narrow_frame_to_blocks(const SurfaceBlocks& surface, RayFrame& ray) {
  double in = ray.start, out = ray.last;
  for (int a = 0; a < 3; ++a) {
    int low = surface.block_min()[a] * block_dim, high = surface.block_end()[a] * block_dim;
    if (ray.octant >> a & 1) {
      const int size = surface.node_dims()[a] * node_dim, mirrored = size - high;
      high = size - low;
      low = mirrored;
    }
    in = std::max(in, walk::plane_time(ray, a, low));
    out = std::min(out, walk::plane_time(ray, a, high));
  }
  return cut(surface, ray, in - 1, out + 1);
}

// They take their steps in turn: a step has to wait for the one before of the same ray, but not for those of
// others, so the processor works on several at a time.
void skip_empty_nodes(const SurfaceBlocks& surface, std::span<RayFrame> rays, std::span<bool> entered) {
  assert(rays.size() == entered.size() && rays.size() <= 256);
  std::uint8_t waiting[256];
  std::size_t count = 0;
  for (std::size_t r = 0; r < rays.size(); ++r)
    if (entered[r]) waiting[count++] = static_cast<std::uint8_t>(r);
  while (count) {
    const std::size_t turns = count;
    count = 0;
    for (std::size_t turn = 0; turn < turns; ++turn) {
      const std::uint8_t r = waiting[turn];
      RayFrame& ray = rays[r];
      const walk::NodeTable table(surface, ray.octant);
      const int leap = table.leaps[table.entry(ray.start_node)];
      if (!leap) continue;
      ++ray.skipped;
      const walk::NodeExit exit(ray, ray.start_node, leap, ray.start);
      ray.start = exit.s;
      entered[r] = exit.move(ray, table, leap, ray.start_node);
      if (entered[r]) waiting[count++] = r;
    }
  }
}

} // namespace levelray
