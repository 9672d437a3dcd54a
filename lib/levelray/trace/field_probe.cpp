#include "levelray/trace/field_probe.hpp"

#include <algorithm>
#include <cmath>

namespace levelray {

FieldProbe probe_field(const BlockGrid& grid, const Vec3d& point) {
  const Vec3d p = grid.transform.to_voxel(point);
  FieldProbe result;
  double x[3];
  int cell[3];
  for (int a = 0; a < 3; ++a) {
    // Everything is outside beyond the nodes; the limit keeps indices in range there.
    const double low = std::clamp(std::floor(p[a]), -0x1p30, 0x1p30);
    cell[a] = static_cast<int>(low);
    x[a] = std::clamp(p[a] - low, 0.0, 1.0);
  }
  double f[8];
  for (int c = 0; c < 8; ++c) {
    f[c] = grid.value(cell[0] + (c & 1), cell[1] + (c >> 1 & 1), cell[2] + (c >> 2));
    result.largest = std::max(result.largest, std::fabs(f[c]));
  }
  const auto mix = [](double a, double b, double t) { return a * (1 - t) + b * t; };
  double y_low[2], y_high[2], d[3];
  for (int k = 0; k < 2; ++k) {
    y_low[k] = mix(f[4 * k], f[4 * k + 1], x[0]);
    y_high[k] = mix(f[4 * k + 2], f[4 * k + 3], x[0]);
  }
  const double z_low = mix(y_low[0], y_high[0], x[1]), z_high = mix(y_low[1], y_high[1], x[1]);
  result.value = mix(z_low, z_high, x[2]);
  d[0] = mix(mix(f[1] - f[0], f[3] - f[2], x[1]), mix(f[5] - f[4], f[7] - f[6], x[1]), x[2]);
  d[1] = mix(y_high[0] - y_low[0], y_high[1] - y_low[1], x[2]);
  d[2] = z_high - z_low;
  result.gradient = Vec3d(d[0], d[1], d[2]) / grid.transform.voxel_size;
  return result;
}

bool lies_on_side(const BlockGrid& grid, const Vec3d& point, double side) {
  const FieldProbe probe = probe_field(grid, point);
  return side * probe.value > 0x1p-26 * probe.largest;
}

std::optional<Vec3d> point_on_side(const BlockGrid& grid, const Vec3d& at, const Vec3d& direction,
                                   double side) {
  for (const double step : {0x1p-20, 0x1p-16, 0x1p-12, 0x1p-8, 0x1p-4, 0x1p-2}) {
    const Vec3d p = at + direction * (step * grid.transform.voxel_size);
    if (lies_on_side(grid, p, side)) return p;
  }
  return std::nullopt;
}

} // namespace levelray
