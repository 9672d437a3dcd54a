// All crossings of zero of a polynomial in an interval, isolated by Bernstein signs.
//
// The number of sign changes of the Bernstein coefficients bounds the number of roots and has its parity
// (Descartes' rule; Lane and Riesenfeld 1981, "Bounds on a polynomial"): none is a proof that there is no
// root, one that there is exactly one. Intervals with more are halved by de Casteljau's algorithm. Every
// halving rounds a coefficient by at most degree * 2^-64 of the largest, so after 64 of them 2^-64 * 64 *
// degree of the largest bounds all of it; coefficients below that decide nothing.
#pragma once

#include "levelray/field/field.hpp"

#include <array>
#include <vector>

namespace levelray {

inline constexpr int quartic_degree = 4;

// c[0] + c[1] t + ... + c[4] t^4.
using Quartic = std::array<Extended, quartic_degree + 1>;

struct Crossings {
  std::vector<Extended> at; // ascending; where the sign changes, to a few 2^-64 of the interval
  bool undecided = false;   // somewhere the polynomial comes too close to zero to tell whether it crosses
};

Crossings crossings_of(const Quartic& polynomial, Extended low, Extended high);

} // namespace levelray
