#include "levelray/normal/offset_differences.hpp"

#include <algorithm>

namespace levelray {

Vec3d OffsetDifferences::gradient(const Neighbourhood& f, const CellPosition& at) {
  // Float is plenty for a direction: 2^-24 of the samples over a voxel.
  float weight[3][2];              // of the two rows across
  float below[3], in[3], above[3]; // of the differences along: from -1 to 0, 0 to 1 and 1 to 2
  for (int a = 0; a < 3; ++a) {
    const float x = static_cast<float>(at.local[a]);
    weight[a][0] = 1 - x, weight[a][1] = x;
    below[a] = std::max(0.5f - x, 0.f), above[a] = std::max(x - 0.5f, 0.f);
    in[a] = 1 - (below[a] + above[a]);
  }

  float sum[3] = {0, 0, 0};
  for (int q = 0; q < 2; ++q)
    for (int p = 0; p < 2; ++p) {
      const auto row = [&](int a, const float(&r)[4]) {
        return below[a] * (r[1] - r[0]) + in[a] * (r[2] - r[1]) + above[a] * (r[3] - r[2]);
      };
      sum[0] +=
          weight[1][p] * weight[2][q] * row(0, {f.at(-1, p, q), f.at(0, p, q), f.at(1, p, q), f.at(2, p, q)});
      sum[1] +=
          weight[0][p] * weight[2][q] * row(1, {f.at(p, -1, q), f.at(p, 0, q), f.at(p, 1, q), f.at(p, 2, q)});
      sum[2] +=
          weight[0][p] * weight[1][q] * row(2, {f.at(p, q, -1), f.at(p, q, 0), f.at(p, q, 1), f.at(p, q, 2)});
    }
  return Vec3d(sum[0], sum[1], sum[2]);
}

} // namespace levelray
