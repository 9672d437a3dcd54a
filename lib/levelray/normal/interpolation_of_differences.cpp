#include "levelray/normal/interpolation_of_differences.hpp"

#include "levelray/normal/neighbourhood.hpp"

namespace levelray {

Vec3d InterpolationOfDifferences::gradient(const BlockGrid& grid, const CellPosition& at) {
  const Neighbourhood f = fetch_neighbourhood(grid, at.cell);
  const double x = at.local[0], y = at.local[1], z = at.local[2];
  const double wx[2] = {1 - x, x}, wy[2] = {1 - y, y}, wz[2] = {1 - z, z};
  Vec3d gradient(0, 0, 0);
  for (int k = 0; k < 2; ++k)
    for (int j = 0; j < 2; ++j)
      for (int i = 0; i < 2; ++i) {
        const double weight = wx[i] * wy[j] * wz[k];
        gradient.x += weight * (double(f.at(i + 1, j, k)) - f.at(i - 1, j, k));
        gradient.y += weight * (double(f.at(i, j + 1, k)) - f.at(i, j - 1, k));
        gradient.z += weight * (double(f.at(i, j, k + 1)) - f.at(i, j, k - 1));
      }
  return gradient * 0.5; // the samples are two voxels apart
}

} // namespace levelray
