// How thick a solid is, and how wide its gaps are: what tells which voxels it needs.
#pragma once

#include <cstddef>
#include <vector>

namespace levelray {

// From places of the surface against their normals to the next place of it. Towards convex edges it goes to
// 0, so small quantiles say more than the minimum. Likewise gaps, along the normals. World units.
struct Thickness {
  std::size_t points = 0, gaps = 0;        // with something there
  double p01 = 0, p1 = 0, p5 = 0, p50 = 0; // quantiles 0.1 %, 1 %, ... of thicknesses
  double gap_p1 = 0, gap_p50 = 0;
  std::vector<double> thin_share; // per voxel size: part of the points thinner than 2 voxels
};

// Of such lengths; what is not positive is no length.
Thickness thickness_statistics(std::vector<double> inward, std::vector<double> outward,
                               const std::vector<double>& voxel_sizes);

} // namespace levelray
