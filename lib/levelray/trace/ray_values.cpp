#include "levelray/trace/ray_values.hpp"

#include "levelray/trace/double_double.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace levelray {

RayValues::RayValues(const BlockGrid& grid, const WorldRay& ray) : grid_(&grid) {
  const int voxel_exponent = std::ilogb(grid.transform.voxel_size);
  voxel_ = std::scalbn(grid.transform.voxel_size, -voxel_exponent);
  const double largest =
      std::max({std::fabs(ray.direction.x), std::fabs(ray.direction.y), std::fabs(ray.direction.z)});
  const int direction_exponent = largest > 0 && std::isfinite(largest) ? std::ilogb(largest) : 0;
  t_exponent_ = direction_exponent - voxel_exponent;
  for (int a = 0; a < 3; ++a) {
    offset_[a][0] = std::scalbn(ray.origin[a], -voxel_exponent);
    offset_[a][1] = -std::scalbn(grid.transform.origin[a], -voxel_exponent);
    direction_[a] = std::scalbn(ray.direction[a], -direction_exponent);
    for (const auto& [original, scaled] :
         {std::pair{ray.origin[a], offset_[a][0]}, std::pair{grid.transform.origin[a], offset_[a][1]},
          std::pair{ray.direction[a], direction_[a]}})
      underflows_ |= original != 0 && std::fabs(scaled) < 0x1p-900;
  }
}

Enclosure RayValues::at(double t) const {
  const double scaled_t = std::scalbn(t, t_exponent_);
  DoubleDouble weight[3][2]; // towards the lower and the upper corners, in units of a voxel's edge
  int cell[3];
  bool tiny = underflows_;
  for (int a = 0; a < 3; ++a) {
    const DoubleDouble way = two_product(scaled_t, direction_[a]);
    ExactSum<8> place;
    place += offset_[a][0];
    place += offset_[a][1];
    place += way;
    const double voxels = place.rounded().high / voxel_;
    if (!(std::fabs(voxels) < 0x1p30)) {
      // Beyond any sample; or there is no such point.
      return {static_cast<double>(grid_->background),
              std::isnan(voxels) ? std::numeric_limits<double>::infinity() : 0};
    }
    double index = std::floor(voxels);
    for (int attempt = 0; attempt < 3; ++attempt) { // the quotient's rounding may put it one off
      const DoubleDouble low = two_product(index, voxel_);
      ExactSum<8> above = place, below;
      above += -low.high;
      above += -low.low;
      below += voxel_;
      below += low;
      below += -offset_[a][0];
      below += -offset_[a][1];
      below += -way.low;
      below += -way.high;
      weight[a][1] = above.rounded();
      weight[a][0] = below.rounded();
      if (weight[a][1].high < 0)
        index -= 1;
      else if (weight[a][0].high < 0)
        index += 1;
      else
        break;
    }
    cell[a] = static_cast<int>(index);
    const auto may_underflow = [](double x, double limit) { return x != 0 && std::fabs(x) < limit; };
    tiny |= may_underflow(way.high, 0x1p-800) || may_underflow(weight[a][0].high, 0x1p-250) ||
            may_underflow(weight[a][1].high, 0x1p-250) || weight[a][0].high < 0 || weight[a][1].high < 0;
  }

  DoubleDouble sum;
  double sizes = 0, largest = 0;
  for (int c = 0; c < 8; ++c) {
    const double corner = grid_->value(cell[0] + (c & 1), cell[1] + (c >> 1 & 1), cell[2] + (c >> 2));
    largest = std::max(largest, std::fabs(corner));
    const DoubleDouble term =
        DoubleDouble{corner, 0} * weight[0][c & 1] * (weight[1][c >> 1 & 1] * weight[2][c >> 2]);
    sum = sum + term;
    sizes += std::fabs(term.high);
  }
  // Relative errors: 2^-103 of each weight, 2^-101 of each of three products, 2^-104 of each of eight sums
  // against the terms so far: less than 2^-96 of the terms' sizes, whose own rounding is nothing beside it.
  // What is lost below 2^-900 to underflow is less than 2^-200 of the largest corner.
  const double volume = voxel_ * voxel_ * voxel_;
  double error = 0x1p-96 * sizes + std::fabs(sum.low);
  if (tiny) error += 0x1p-200 * largest;
  // Two roundings of the quotient, and its own.
  const double value = sum.high / volume;
  return {value, error / volume * (1 + 0x1p-50) + std::fabs(value) * 0x1p-51};
}

} // namespace levelray
