// The first root of the cubic along a segment, never lost and never invented.
//
// Source: the cubic of the trilinear interpolant as in Parker et al. 1998 and Marmitt et al. 2004, whose idea
// of splitting at the extrema we keep; ours decides by Bernstein signs first, looks at one extremum only, and
// never solves the cubic in closed form, which is unstable near double roots.
//
// Let the ray begin outside (else everything is negated). With b0 > 0 a first root exists iff b3 <= 0 or the
// cubic's local minimum m lies in the segment and f(m) <= 0; and
//  - f(m) <= 0: exactly one root lies in [0, m], because f falls from its maximum, or from 0, to m;
//  - else b3 <= 0: exactly one root lies in [0, 1], because f > 0 up to its maximum and falls from there.
// m is the root of the quadratic derivative where it grows, in the form without cancellation. An error d of m
// moves f(m) by O(d^2), so the decision is that of the true cubic up to rounding of the coefficients: a few
// 16 * 2^-53 of the largest corner (bernstein.hpp). A touch within that bound may count as either.
#pragma once

#include "levelray/intersect/bernstein.hpp"
#include "levelray/intersect/cell_root.hpp"

#include <cmath>
#include <string_view>

namespace levelray {

struct Exact {
  static constexpr std::string_view name = "exact";
  static constexpr std::string_view source =
      "first root of the trilinear cubic; Parker et al. 1998, Marmitt et al. 2004";

  template <class Count = NoCount>
  static bool exists(const CellSegment& segment, double side, Count&& count = {}) {
    count(bernstein_interpolations);
    if (surely_positive(segment, side)) return false;
    count(bernstein_interpolations);
    return last_of_bracket(oriented(segment, side)) >= 0;
  }

  template <class Count = NoCount>
  static bool find(const CellSegment& segment, double side, CellRoot& root, Count&& count = {}) {
    count(bernstein_interpolations);
    if (surely_positive(segment, side)) return false;
    count(bernstein_interpolations);
    const Bernstein<double> f = oriented(segment, side);
    const double last = last_of_bracket(f);
    if (!(last >= 0)) return false;
    polish(f, last, safety_margin(segment), root);
    return true;
  }

  // The end of a bracket [0, end] that holds exactly one root of f, 0 where f(0) <= 0 already, or -1 where f
  // has no root in [0,1].
  static double last_of_bracket(const Bernstein<double>& f);
  // The root in the bracket [0, last], f(0) > 0 >= f(last), or 0 where last is; root.outside is where f
  // exceeds `margin`.
  static void polish(const Bernstein<double>& f, double last, double margin, CellRoot& root);
  // Where the cubic has its local minimum, if that is in (0,1); else -1.
  static double local_minimum(const Bernstein<double>& f);
  static double evaluate(const Bernstein<double>& f, double s);

 private:
  // All coefficients positive, by float arithmetic with its error bound.
  static bool surely_positive(const CellSegment& segment, double side) {
    const Bernstein<float> f = bernstein_along<float>(segment);
    const float sign = static_cast<float>(side), error = segment.error;
    return (f.start * sign > error) & (f.sum1 * sign > 3 * error) & (f.sum2 * sign > 3 * error) &
           (f.end * sign > error);
  }
};

} // namespace levelray
