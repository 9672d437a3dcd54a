#include "levelray/normal/tricubic_b_spline.hpp"

namespace levelray {

Vec3d TricubicBSpline::gradient(const Neighbourhood& f, const CellPosition& at) {
  // The four basis functions that are not zero between samples 0 and 1, and their derivatives. Float is
  // plenty for a direction.
  float value[3][4], slope[3][4];
  for (int a = 0; a < 3; ++a) {
    const float x = static_cast<float>(at.local[a]), r = 1 - x;
    value[a][0] = r * r * r * (1.f / 6);
    value[a][1] = (4 + 3 * (x * x) * (x - 2)) * (1.f / 6);
    value[a][2] = (4 + 3 * (r * r) * (r - 2)) * (1.f / 6);
    value[a][3] = x * x * x * (1.f / 6);
    slope[a][0] = -0.5f * (r * r);
    slope[a][1] = x * (1.5f * x - 2);
    slope[a][2] = r * (2 - 1.5f * r);
    slope[a][3] = 0.5f * (x * x);
  }

  // Fold z, then y, then x, each as values and slopes.
  float gx = 0, gy = 0, gz = 0;
  for (int i = 0; i < 4; ++i) {
    float plain = 0, dy = 0, dz = 0;
    for (int j = 0; j < 4; ++j) {
      float column = 0, column_dz = 0;
      for (int k = 0; k < 4; ++k) {
        const float sample = f.at(i - 1, j - 1, k - 1);
        column += value[2][k] * sample;
        column_dz += slope[2][k] * sample;
      }
      plain += value[1][j] * column;
      dy += slope[1][j] * column;
      dz += value[1][j] * column_dz;
    }
    gx += slope[0][i] * plain;
    gy += value[0][i] * dy;
    gz += value[0][i] * dz;
  }
  return Vec3d(gx, gy, gz);
}

} // namespace levelray
