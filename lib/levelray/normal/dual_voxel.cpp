#include "levelray/normal/dual_voxel.hpp"

#include <cmath>

namespace levelray {

namespace {

// The gradient of the trilinear polynomial of the cell with lowest corner `cell` at p, which counts from
// there.
Vec3d cell_gradient(const Neighbourhood& f, const int (&cell)[3], const double (&p)[3]) {
  double v[8];
  for (int c = 0; c < 8; ++c)
    v[c] = double(f.at(cell[0] + (c & 1), cell[1] + (c >> 1 & 1), cell[2] + (c >> 2)));
  const auto mix = [](double a, double b, double w) { return a * (1 - w) + b * w; };
  return Vec3d(mix(mix(v[1] - v[0], v[3] - v[2], p[1]), mix(v[5] - v[4], v[7] - v[6], p[1]), p[2]),
               mix(mix(v[2] - v[0], v[3] - v[1], p[0]), mix(v[6] - v[4], v[7] - v[5], p[0]), p[2]),
               mix(mix(v[4] - v[0], v[5] - v[1], p[0]), mix(v[6] - v[2], v[7] - v[3], p[0]), p[1]));
}

} // namespace

Vec3d DualVoxel::gradient(const Neighbourhood& f, const CellPosition& at) {
  int first[3];    // the lowest of the eight cells
  double place[3]; // in the dual voxel, from that cell's centre
  for (int a = 0; a < 3; ++a) {
    first[a] = at.local[a] < 0.5 ? -1 : 0;
    place[a] = at.local[a] - 0.5 - first[a];
  }
  Vec3d sum(0, 0, 0);
  for (int c = 0; c < 8; ++c) {
    int cell[3];
    double p[3], weight = 1;
    for (int a = 0; a < 3; ++a) {
      const int upper = c >> a & 1;
      cell[a] = first[a] + upper;
      p[a] = at.local[a] - cell[a];
      weight *= upper ? place[a] : 1 - place[a];
    }
    const Vec3d g = cell_gradient(f, cell, p);
    const double square = g.dot(g);
    if (square > 0) sum += g * (weight / std::sqrt(square)); // samples are floats: no over- or underflow
  }
  return sum;
}

} // namespace levelray
