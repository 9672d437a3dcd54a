#include "levelray/accel/node_walk.hpp"

#include <cassert>

namespace levelray {

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
