// The roots in [0,1] of a cubic with exact coefficients, isolated without any doubt.
#pragma once

#include "oracle/dyadic.hpp"

#include <vector>

namespace levelray::test {

// b0 (1-u)^3 + 3 b1 (1-u)^2 u + 3 b2 (1-u) u^2 + b3 u^3.
struct ExactCubic {
  Dyadic b[4];
};

struct ExactRoot {
  long double u = 0, error = 0; // |u - root| <= error
  int sign_after = 0; // of the cubic between this root and the next, or u = 1; 0 for a root at u = 1
};

// All distinct roots in [0,1], ascending; with them `sign_before`, the sign at 0 (0 where 0 is a root). A
// cubic that is 0 everywhere has the roots 0 and 1 and signs 0.
//
// Method: Descartes' rule of signs on Bernstein coefficients, halving (Collins and Akritas 1976); repeated
// roots, on which halving would not end, are recognised by a discriminant that is exactly 0 and computed.
std::vector<ExactRoot> exact_roots(const ExactCubic& cubic, int& sign_before);

} // namespace levelray::test
