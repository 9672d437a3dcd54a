#include "levelray/normal/analytic.hpp"

namespace levelray {

Vec3d AnalyticNormal::gradient(const BlockGrid& grid, const CellPosition& at) {
  double f[2][2][2]; // [z][y][x]
  for (int c = 0; c < 8; ++c)
    f[c >> 2][c >> 1 & 1][c & 1] =
        grid.value(at.cell.x + (c & 1), at.cell.y + (c >> 1 & 1), at.cell.z + (c >> 2));
  const double x = at.local[0], y = at.local[1], z = at.local[2];
  const auto mix = [](double a, double b, double w) { return a * (1 - w) + b * w; };

  // Each component is the bilinear interpolation of the differences along its four edges.
  const auto dx = [&](int k, int j) { return f[k][j][1] - f[k][j][0]; };
  const auto dy = [&](int k, int i) { return f[k][1][i] - f[k][0][i]; };
  const auto dz = [&](int j, int i) { return f[1][j][i] - f[0][j][i]; };
  return Vec3d(mix(mix(dx(0, 0), dx(0, 1), y), mix(dx(1, 0), dx(1, 1), y), z),
               mix(mix(dy(0, 0), dy(0, 1), x), mix(dy(1, 0), dy(1, 1), x), z),
               mix(mix(dz(0, 0), dz(0, 1), x), mix(dz(1, 0), dz(1, 1), x), y));
}

} // namespace levelray
