#include "levelray/normal/difference_of_interpolations.hpp"

namespace levelray {

namespace {

// The trilinear interpolant at local coordinates in [0, 3/2], of which one at most is beyond 1.
double interpolate(const Neighbourhood& f, const double (&p)[3]) {
  int base[3];
  double w[3];
  for (int a = 0; a < 3; ++a) {
    base[a] = p[a] > 1 ? 1 : 0;
    w[a] = p[a] - base[a];
  }
  double sum = 0;
  for (int c = 0; c < 8; ++c) {
    const int i = c & 1, j = c >> 1 & 1, k = c >> 2;
    sum += (i ? w[0] : 1 - w[0]) * (j ? w[1] : 1 - w[1]) * (k ? w[2] : 1 - w[2]) *
           double(f.at(base[0] + i, base[1] + j, base[2] + k));
  }
  return sum;
}

} // namespace

Vec3d DifferenceOfInterpolations::gradient(const Neighbourhood& f, const CellPosition& at) {
  const double here = interpolate(f, at.local);
  Vec3d gradient;
  for (int a = 0; a < 3; ++a) {
    double above[3] = {at.local[0], at.local[1], at.local[2]};
    above[a] += offset_voxels;
    gradient[a] = (interpolate(f, above) - here) / offset_voxels;
  }
  return gradient;
}

} // namespace levelray
