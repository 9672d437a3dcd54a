// A slow tracer to compare with: every cell of the grid's box that the ray's line comes near, in long double,
// by isolating all roots of each cell's cubic. No code in common with the library but reading samples.
#pragma once

#include "levelray/core/ray.hpp"
#include "levelray/grid/block_grid.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace levelray::test {

using Real = long double;

// f along o + t d in one cell as a polynomial c0 + c1 t + c2 t^2 + c3 t^3, from the trilinear monomials.
struct CellCubic {
  Real c[4];

  CellCubic(const float (&f)[8], const Real (&o)[3], const Real (&d)[3]) {
    const Real a0 = f[0], a1 = Real(f[1]) - f[0], a2 = Real(f[2]) - f[0], a3 = Real(f[4]) - f[0];
    const Real a4 = Real(f[3]) - f[2] - f[1] + f[0], a5 = Real(f[5]) - f[4] - f[1] + f[0],
               a6 = Real(f[6]) - f[4] - f[2] + f[0];
    const Real a7 = Real(f[7]) - f[6] - f[5] + f[4] - f[3] + f[2] + f[1] - f[0];
    const Real x = o[0], y = o[1], z = o[2], u = d[0], v = d[1], w = d[2];
    c[0] = a0 + a1 * x + a2 * y + a3 * z + a4 * x * y + a5 * x * z + a6 * y * z + a7 * x * y * z;
    c[1] = a1 * u + a2 * v + a3 * w + a4 * (x * v + y * u) + a5 * (x * w + z * u) + a6 * (y * w + z * v) +
           a7 * (x * y * w + x * z * v + y * z * u);
    c[2] = a4 * u * v + a5 * u * w + a6 * v * w + a7 * (x * v * w + y * u * w + z * u * v);
    c[3] = a7 * u * v * w;
  }
  Real operator()(Real t) const { return ((c[3] * t + c[2]) * t + c[1]) * t + c[0]; }

  // The ends of [a,b] and the extrema between them, ascending: f is monotone from each to the next.
  std::vector<Real> monotone_pieces(Real a, Real b) const {
    std::vector<Real> ends{a};
    Real extrema[2];
    int count = 0;
    const Real A = 3 * c[3], B = c[2], C = c[1]; // A t^2 + 2 B t + C
    const Real discriminant = B * B - A * C;
    if (discriminant >= 0) {
      const Real q = -(B + std::copysign(std::sqrt(discriminant), B));
      if (A != 0) extrema[count++] = q / A;
      if (q != 0) extrema[count++] = C / q;
    }
    if (count == 2 && extrema[1] < extrema[0]) std::swap(extrema[0], extrema[1]);
    for (int i = 0; i < count; ++i)
      if (extrema[i] > a && extrema[i] < b) ends.push_back(extrema[i]);
    ends.push_back(b);
    return ends;
  }
};

// What the reference says of a ray.
struct ReferenceHit {
  bool hit = false;
  Real t = 0;           // first t with side * f <= 0
  Real closest = 1e30L; // the least side * f in the surface cells met, to the end of the cell of the hit: the
                        // error of f that would change the answer
  bool from_inside = false;
};

// The first t in [a,b] where side * f <= 0, by bisection of the first monotone piece that gets there.
inline std::optional<Real> first_crossing(const CellCubic& f, Real side, Real a, Real b, Real& least) {
  const std::vector<Real> ends = f.monotone_pieces(a, b);
  std::optional<Real> root;
  if (side * f(a) <= 0) root = a;
  for (std::size_t i = 0; i < ends.size(); ++i) least = std::min(least, side * f(ends[i]));
  for (std::size_t i = 0; !root && i + 1 < ends.size(); ++i) {
    Real low = ends[i], high = ends[i + 1];
    if (side * f(high) > 0) continue;
    for (int step = 0; step < 100 && low < high; ++step) {
      const Real middle = (low + high) / 2;
      if (middle <= low || middle >= high) break;
      (side * f(middle) > 0 ? low : high) = middle;
    }
    root = high;
  }
  return root;
}

// Steps over every unit slab of the major axis, and in it over every cell near the line. The cell that holds
// the beginning decides the side; cells whose corners have one strict sign are passed over.
class ReferenceTracer {
 public:
  explicit ReferenceTracer(const BlockGrid& grid) : grid_(grid) {}

  ReferenceHit closest(const WorldRay& ray) const {
    Real o[3], d[3];
    for (int a = 0; a < 3; ++a) {
      o[a] = (Real(ray.origin[a]) - grid_.transform.origin[a]) / grid_.transform.voxel_size;
      d[a] = Real(ray.direction[a]) / grid_.transform.voxel_size;
    }
    const int major = std::fabs(d[0]) >= std::fabs(d[1]) ? (std::fabs(d[0]) >= std::fabs(d[2]) ? 0 : 2)
                                                         : (std::fabs(d[1]) >= std::fabs(d[2]) ? 1 : 2);
    const int low = grid_.node_min[major] * node_dim;
    const int high = low + grid_.node_dims[major] * node_dim; // slabs low .. high-1

    // The side of the beginning.
    ReferenceHit result;
    Real side = 1;
    {
      const Real t = std::max<Real>(ray.t_min, -1e30L);
      int cell[3];
      Real local[3];
      bool near = true;
      for (int a = 0; a < 3; ++a) {
        const Real p = o[a] + t * d[a];
        near &= std::fabs(p) < 1e8L;
        if (near) cell[a] = static_cast<int>(std::floor(p)), local[a] = p - cell[a];
      }
      if (near) {
        float f[8];
        corners(cell, f);
        const Real zero[3] = {0, 0, 0};
        if (CellCubic(f, local, zero).c[0] < 0) side = -1;
      }
    }
    result.from_inside = side < 0;

    const int forward = d[major] > 0 ? 1 : -1;
    for (int n = 0; n < high - low; ++n) {
      const int slab = forward > 0 ? low + n : high - 1 - n;
      Real t0 = (slab - o[major]) / d[major], t1 = (slab + 1 - o[major]) / d[major];
      if (t0 > t1) std::swap(t0, t1);
      t0 = std::max<Real>(t0, ray.t_min), t1 = std::min<Real>(t1, ray.t_max);
      if (t0 > t1) continue;

      // All cells of the slab near the chord, each with its own slabs; the earliest root wins.
      const int u = (major + 1) % 3, v = (major + 2) % 3;
      const auto range = [&](int a, int& first, int& last) {
        const Real p0 = o[a] + t0 * d[a], p1 = o[a] + t1 * d[a];
        first = static_cast<int>(std::floor(std::clamp<Real>(std::min(p0, p1) - 1e-9L, -1e8L, 1e8L)));
        last = static_cast<int>(std::floor(std::clamp<Real>(std::max(p0, p1) + 1e-9L, -1e8L, 1e8L)));
      };
      int u0, u1, v0, v1;
      range(u, u0, u1), range(v, v0, v1);
      bool found = false;
      for (int i = u0; i <= u1; ++i)
        for (int j = v0; j <= v1; ++j) {
          int cell[3];
          cell[major] = slab, cell[u] = i, cell[v] = j;
          Real in = t0, out = t1;
          for (const int a : {u, v}) {
            if (d[a] == 0) {
              if (o[a] < cell[a] || o[a] > cell[a] + 1) out = in - 1;
              continue;
            }
            const Real s0 = (cell[a] - o[a]) / d[a], s1 = (cell[a] + 1 - o[a]) / d[a];
            in = std::max(in, std::min(s0, s1)), out = std::min(out, std::max(s0, s1));
          }
          if (in > out) continue;
          float f[8];
          if (!corners(cell, f)) continue;
          Real local[3];
          for (int a = 0; a < 3; ++a) local[a] = o[a] + in * d[a] - cell[a];
          const CellCubic cubic(f, local, d);
          const std::optional<Real> root = first_crossing(cubic, side, 0, out - in, result.closest);
          if (root && (!found || in + *root < result.t)) {
            result.hit = found = true;
            result.t = in + *root;
          }
        }
      if (found) break;
    }
    return result;
  }

 private:
  // Fills the corners; false where all have the same strict sign.
  bool corners(const int (&cell)[3], float (&f)[8]) const {
    bool negative = false, positive = false;
    for (int c = 0; c < 8; ++c) {
      f[c] = grid_.value(cell[0] + (c & 1), cell[1] + (c >> 1 & 1), cell[2] + (c >> 2));
      negative |= f[c] <= 0;
      positive |= f[c] >= 0;
    }
    return negative && positive;
  }

  const BlockGrid& grid_;
};

} // namespace levelray::test
