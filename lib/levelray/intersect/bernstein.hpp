// The trilinear interpolant along a segment of a ray: a cubic in Bernstein form.
//
// f is affine in each coordinate, so with F(a,b,c) = f(x_a, y_b, z_c), where each digit takes the coordinate
// of the segment's start (0) or end (1), the blossom of the cubic gives
//   b0 = F000, b1 = (F100 + F010 + F001)/3, b2 = (F110 + F101 + F011)/3, b3 = F111
// (the cubic itself: Parker et al. 1998; its power basis loses six times as many digits). b0 and b3 are the
// interpolant at the ends, computed just as `interpolate` does, so that neighbours agree on shared faces. The
// cubic lies in the convex hull of b0..b3: four coefficients of one sign are a proof that there is no root.
// We keep 3 b1 and 3 b2, which saves a rounding: the cubic of corners that are small integers is exact.
//
// Rounding, with u = 2^-53 or 2^-24 and M the largest |corner|: a weight is rounded once, its product and the
// sum once each, so a level of interpolation adds at most 3u M and three levels 9u M. A sum of three values
// adds 2u 3M to three times that: 33u M. So b0 and b3 are off by less than 16u M, and 3 b1 and 3 b2 by less
// than three times as much. Products that underflow in float lose at most 2^-149 each (2^-126 where a host
// flushes denormals): 2^-120 covers them. CellSegment::error holds 2^-20 M + 2^-120.
#pragma once

#include "levelray/grid/cell_segment.hpp"

namespace levelray {

// f(s) = start (1-s)^3 + sum1 (1-s)^2 s + sum2 (1-s) s^2 + end s^3.
template <class T>
struct Bernstein {
  T start, sum1, sum2, end;
};

// The same cubic in the power basis, c0 + c1 s + c2 s^2 + c3 s^3: one sum fewer per value, and equally good
// in double. With M the largest |corner| and u = 2^-53: the coefficients' sums are off by 48 u M, c1, c2, c3
// are at most 6, 12 and 8 M, and six operations on them round, so values are within 2^-44 M.
struct PowerCubic {
  double c0, c1, c2, c3;

  explicit PowerCubic(const Bernstein<double>& f)
      : c0(f.start), c1(f.sum1 - 3 * f.start), c2((f.sum2 - f.sum1) - c1),
        c3((f.end - f.start) - (f.sum2 - f.sum1)) {}
  double operator()(double s) const { return ((c3 * s + c2) * s + c1) * s + c0; }
  double slope(double s) const { return (3 * c3 * s + 2 * c2) * s + c1; }
};

// The values F of the blossom.
inline constexpr int bernstein_interpolations = 8;

// Written in lanes of four, one for each choice of ends in x and y, which compilers turn into vectors; the
// operations on each value are those of `interpolate`.
template <class T>
inline Bernstein<T> bernstein_along(const CellSegment& segment) {
  struct Lanes {
    T v[4];
  };
  const auto x_lanes = [](double in, double out) { return Lanes{T(in), T(out), T(in), T(out)}; };
  const auto y_lanes = [](double in, double out) { return Lanes{T(in), T(in), T(out), T(out)}; };
  const Lanes x = x_lanes(segment.in.x[0], segment.out.x[0]),
              x_rest = x_lanes(segment.in.rest[0], segment.out.rest[0]);
  const Lanes y = y_lanes(segment.in.x[1], segment.out.x[1]),
              y_rest = y_lanes(segment.in.rest[1], segment.out.rest[1]);

  Lanes along_y[2]; // at z = 0 and 1
  for (int k = 0; k < 2; ++k) {
    const T c00 = T(segment.corner[4 * k]), c10 = T(segment.corner[4 * k + 1]);
    const T c01 = T(segment.corner[4 * k + 2]), c11 = T(segment.corner[4 * k + 3]);
    for (int l = 0; l < 4; ++l) {
      const T low = lerp_exact_ends(c00, c10, x_rest.v[l], x.v[l]);
      const T high = lerp_exact_ends(c01, c11, x_rest.v[l], x.v[l]);
      along_y[k].v[l] = lerp_exact_ends(low, high, y_rest.v[l], y.v[l]);
    }
  }
  Lanes f0, f1; // at the start and the end in z
  const T z0 = T(segment.in.x[2]), z0_rest = T(segment.in.rest[2]);
  const T z1 = T(segment.out.x[2]), z1_rest = T(segment.out.rest[2]);
  for (int l = 0; l < 4; ++l) f0.v[l] = lerp_exact_ends(along_y[0].v[l], along_y[1].v[l], z0_rest, z0);
  for (int l = 0; l < 4; ++l) f1.v[l] = lerp_exact_ends(along_y[0].v[l], along_y[1].v[l], z1_rest, z1);

  return {f0.v[0], f0.v[1] + f0.v[2] + f1.v[0], f0.v[3] + f1.v[1] + f1.v[2], f1.v[3]};
}

// Times `side`, 1 or -1, so that it is positive where the ray began.
inline Bernstein<double> oriented(const CellSegment& segment, double side) {
  const Bernstein<double> f = bernstein_along<double>(segment);
  return {f.start * side, f.sum1 * side, f.sum2 * side, f.end * side};
}

} // namespace levelray
