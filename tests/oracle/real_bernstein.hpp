// f along a piece of a line in a cell, in long double.
#pragma once

#include "oracle/ray_oracle.hpp"

#include <algorithm>
#include <cmath>

namespace levelray::test {

inline int index_of(Real x) {
  return static_cast<int>(std::floor(std::clamp<Real>(x, -1e8L, 1e8L)));
}

struct RealBernstein {
  Real b[4];

  Real operator()(Real u) const {
    const Real r = 1 - u;
    return (b[0] * r + 3 * b[1] * u) * (r * r) + (3 * b[2] * r + b[3] * u) * (u * u);
  }
};

// f from the point p to the point q of a cell.
inline RealBernstein along(const float (&f)[8], const Real (&p)[3], const Real (&q)[3]) {
  const auto blossom = [&](int a, int b, int c) {
    const Real x = a ? q[0] : p[0], y = b ? q[1] : p[1], z = c ? q[2] : p[2];
    const auto row = [&](int i) { return Real(f[i]) * (1 - x) + Real(f[i + 1]) * x; };
    return (row(0) * (1 - y) + row(2) * y) * (1 - z) + (row(4) * (1 - y) + row(6) * y) * z;
  };
  return {{blossom(0, 0, 0), (blossom(1, 0, 0) + blossom(0, 1, 0) + blossom(0, 0, 1)) / 3,
           (blossom(1, 1, 0) + blossom(1, 0, 1) + blossom(0, 1, 1)) / 3, blossom(1, 1, 1)}};
}

} // namespace levelray::test
