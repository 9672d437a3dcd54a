#include "levelray/normal/analytic.hpp"

namespace levelray {

Vec3d AnalyticNormal::gradient(const Neighbourhood& f, const CellPosition& at) {
  const double x = at.local[0], y = at.local[1], z = at.local[2];
  const auto mix = [](double a, double b, double w) { return a * (1 - w) + b * w; };

  // Each component is the bilinear interpolation of the differences along its four edges.
  const auto dx = [&](int k, int j) { return double(f.at(1, j, k)) - f.at(0, j, k); };
  const auto dy = [&](int k, int i) { return double(f.at(i, 1, k)) - f.at(i, 0, k); };
  const auto dz = [&](int j, int i) { return double(f.at(i, j, 1)) - f.at(i, j, 0); };
  return Vec3d(mix(mix(dx(0, 0), dx(0, 1), y), mix(dx(1, 0), dx(1, 1), y), z),
               mix(mix(dy(0, 0), dy(0, 1), x), mix(dy(1, 0), dy(1, 1), x), z),
               mix(mix(dz(0, 0), dz(0, 1), x), mix(dz(1, 0), dz(1, 1), x), y));
}

} // namespace levelray
