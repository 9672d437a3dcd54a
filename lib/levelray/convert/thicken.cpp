#include "levelray/convert/thicken.hpp"

#include "levelray/core/parallel.hpp"

#include <cmath>

namespace levelray {

std::vector<NodeSides> thicken_band(Band& band, double radius_voxels) {
  std::vector<NodeSides> sides(band.box.count());
  parallel_for(sides.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) {
      if (band.node_at[n] == Band::untouched) continue; // farther than R from the surface
      NodeBand& node = band.nodes[static_cast<std::size_t>(band.node_at[n])];
      std::vector<std::uint64_t> masks(64, 0);
      std::uint64_t any = 0;
      for (int b = 0; b < 64; ++b) {
        if (!(node.kept >> b & 1)) continue;
        float* distance = &node.distance[node.kept_index(b) * samples_per_block];
        std::uint64_t inside = 0;
        for (int s = 0; s < samples_per_block; ++s) {
          const double beyond = double{distance[s]} - radius_voxels; // infinity stays
          inside |= std::uint64_t{beyond < 0} << s;
          distance[s] = static_cast<float>(std::fabs(beyond));
        }
        masks[static_cast<std::size_t>(b)] = inside;
        any |= inside;
      }
      if (any) sides[n].blocks = std::move(masks);
    }
  });
  return sides;
}

} // namespace levelray
