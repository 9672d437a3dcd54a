#include "levelray/normal/interpolation_of_differences.hpp"

namespace levelray {

Vec3d InterpolationOfDifferences::gradient(const Neighbourhood& f, const CellPosition& at) {
  // Float is plenty for a direction: 2^-24 of the samples over a voxel.
  float w[3][2];
  for (int a = 0; a < 3; ++a) {
    w[a][1] = static_cast<float>(at.local[a]);
    w[a][0] = 1 - w[a][1];
  }

  // Along its own axis a component needs four samples in a row: the difference around the lower corner and
  // that around the upper one; across, it is interpolated between four such rows.
  float sum[3] = {0, 0, 0};
  for (int q = 0; q < 2; ++q)
    for (int p = 0; p < 2; ++p) {
      const auto row = [&](int a, const float(&r)[4]) {
        return w[a][0] * (r[2] - r[0]) + w[a][1] * (r[3] - r[1]);
      };
      sum[0] += w[1][p] * w[2][q] * row(0, {f.at(-1, p, q), f.at(0, p, q), f.at(1, p, q), f.at(2, p, q)});
      sum[1] += w[0][p] * w[2][q] * row(1, {f.at(p, -1, q), f.at(p, 0, q), f.at(p, 1, q), f.at(p, 2, q)});
      sum[2] += w[0][p] * w[1][q] * row(2, {f.at(p, q, -1), f.at(p, q, 0), f.at(p, q, 1), f.at(p, q, 2)});
    }
  return Vec3d(sum[0], sum[1], sum[2]) * 0.5; // the samples are two voxels apart
}

} // namespace levelray
