// The piece of a ray inside one cell: what every intersector gets to see.
//
// Cell-local coordinates run over [0,1] along each axis. The traversal mirrors axes so that a ray never runs
// towards smaller coordinates; the corners are mirrored with them, so an intersector need not know.
#pragma once

namespace levelray {

// A point of a cell. `rest` is 1 - x, rounded on its own rather than from x, so that mirrored rays compute
// the same bits.
struct CellPoint {
  double x[3] = {0, 0, 0};
  double rest[3] = {1, 1, 1};
};

struct CellSegment {
  float corner[8] = {}; // samples in world units, corner x + 2y + 4z
  float error = 0; // bounds the rounding of the Bernstein coefficients in float arithmetic; see bernstein.hpp
  CellPoint in, out; // where the ray enters and leaves; a coordinate on a crossed face is exactly 0 or 1
};

// a (1-x) + b x: exact at both ends, so that cells agree bit for bit on a shared face.
template <class T>
constexpr T lerp_exact_ends(T a, T b, T rest, T x) {
  return a * rest + b * x;
}

// The trilinear interpolant of the corners.
inline double interpolate(const float (&corner)[8], const CellPoint& p) {
  double along_x[4];
  for (int i = 0; i < 4; ++i)
    along_x[i] = lerp_exact_ends<double>(corner[2 * i], corner[2 * i + 1], p.rest[0], p.x[0]);
  const double low = lerp_exact_ends(along_x[0], along_x[1], p.rest[1], p.x[1]);
  const double high = lerp_exact_ends(along_x[2], along_x[3], p.rest[1], p.x[1]);
  return lerp_exact_ends(low, high, p.rest[2], p.x[2]);
}

// The point at `fraction` of the way from `in` to `out`.
inline CellPoint point_at(const CellSegment& segment, double fraction) {
  CellPoint p;
  for (int a = 0; a < 3; ++a) {
    p.x[a] = lerp_exact_ends(segment.in.x[a], segment.out.x[a], 1 - fraction, fraction);
    p.rest[a] = lerp_exact_ends(segment.in.rest[a], segment.out.rest[a], 1 - fraction, fraction);
  }
  return p;
}

} // namespace levelray
