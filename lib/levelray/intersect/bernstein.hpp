// The trilinear interpolant along a segment of a ray: a cubic in Bernstein form.
//
// f is affine in each coordinate, so with F(a,b,c) = f(x_a, y_b, z_c), where each digit takes the coordinate
// of the segment's start (0) or end (1), the blossom of the cubic gives
//   b0 = F000, b1 = (F100 + F010 + F001)/3, b2 = (F110 + F101 + F011)/3, b3 = F111
// (the cubic itself: Parker et al. 1998; its power basis loses six times as many digits). b0 and b3 are the
// interpolant at the ends, computed just as `interpolate` does, so that neighbours agree on shared faces. The
// cubic lies in the convex hull of b0..b3: four coefficients of one sign are a proof that there is no root.
//
// Rounding, with u = 2^-53 or 2^-24 and M the largest |corner|: a weight is rounded once, its product and the
// sum once each, so a level of interpolation adds at most 3u M, three levels 9u M; the mean of three adds at
// most 4u M. Together 13u M (1 + O(u)) < 16u M. Products that underflow in float lose at most 2^-149 each
// (2^-126 where a host flushes denormals): 2^-120 covers them. CellSegment::error holds 2^-20 M + 2^-120.
#pragma once

#include "levelray/grid/cell_segment.hpp"

namespace levelray {

template <class T>
struct Bernstein {
  T b[4];
};

template <class T>
inline Bernstein<T> bernstein_along(const CellSegment& segment) {
  T x[2], x_rest[2], y[2], y_rest[2], z[2], z_rest[2];
  for (int e = 0; e < 2; ++e) {
    const CellPoint& p = e ? segment.out : segment.in;
    x[e] = static_cast<T>(p.x[0]), x_rest[e] = static_cast<T>(p.rest[0]);
    y[e] = static_cast<T>(p.x[1]), y_rest[e] = static_cast<T>(p.rest[1]);
    z[e] = static_cast<T>(p.x[2]), z_rest[e] = static_cast<T>(p.rest[2]);
  }
  T f[8]; // x + 2y + 4z, digits choosing the end
  for (int a = 0; a < 2; ++a) {
    T along_x[4];
    for (int i = 0; i < 4; ++i)
      along_x[i] = lerp_exact_ends(static_cast<T>(segment.corner[2 * i]),
                                   static_cast<T>(segment.corner[2 * i + 1]), x_rest[a], x[a]);
    for (int b = 0; b < 2; ++b) {
      const T low = lerp_exact_ends(along_x[0], along_x[1], y_rest[b], y[b]);
      const T high = lerp_exact_ends(along_x[2], along_x[3], y_rest[b], y[b]);
      for (int c = 0; c < 2; ++c) f[a + 2 * b + 4 * c] = lerp_exact_ends(low, high, z_rest[c], z[c]);
    }
  }
  const T third = T(1) / T(3);
  return {{f[0], (f[1] + f[2] + f[4]) * third, (f[3] + f[5] + f[6]) * third, f[7]}};
}

} // namespace levelray
