#include "levelray/intersect/exact.hpp"

#include <algorithm>

namespace levelray {

// In the Bernstein basis, whose terms do not cancel beyond the hull of the coefficients.
double Exact::evaluate(const Bernstein<double>& f, double s) {
  const double r = 1 - s;
  return (f.start * r + f.sum1 * s) * (r * r) + (f.sum2 * r + f.end * s) * (s * s);
}

// With the derivative's Bernstein coefficients d0, d1, d2 it is A s^2 + 2 B s + C, A = d0 - 2 d1 + d2,
// B = d1 - d0, C = d0, and grows at (-B + sqrt(B^2 - A C)) / A.
double Exact::local_minimum(const Bernstein<double>& f) {
  const double d0 = f.sum1 - 3 * f.start, d1 = f.sum2 - f.sum1, d2 = 3 * f.end - f.sum2;
  const double discriminant = d1 * d1 - d0 * d2; // B^2 - A C, where most terms cancel exactly
  if (!(discriminant >= 0)) return -1;
  const double root = std::sqrt(discriminant), half = d1 - d0;
  const double s = half <= 0 ? (root - half) / (d0 - d1 + (d2 - d1)) : -d0 / (half + root);
  return s > 0 && s < 1 ? s : -1;
}

double Exact::last_of_bracket(const Bernstein<double>& f) {
  if (!(f.start > 0)) return 0;
  const bool ends = f.end <= 0;
  // One change of sign: one root. Where f does not clearly fall to its end, that may be 0, or what rounding
  // makes of 0, and so a second root to the eye of `polish`: a minimum before it has to end the bracket.
  // 2^-40 is far above the rounding of the coefficients, 2^-47, and small enough to be rare.
  if (ends && (f.sum1 > 0 || f.sum2 <= 0) &&
      f.sum2 - 3 * f.end > 0x1p-40 * (f.start - f.end + std::fabs(f.sum1)))
    return 1;
  // A minimum can only matter where the middle coefficients dip and come back.
  if (!ends && f.sum1 > 0 && f.sum2 > 0) return -1;
  const double minimum = local_minimum(f);
  if (minimum > 0 && evaluate(f, minimum) <= 0) return minimum;
  return ends ? 1 : -1;
}

// Newton's method from the false position, kept inside the bracket by bisection.
void Exact::polish(const Bernstein<double>& f, double last, double margin, CellRoot& root) {
  root.at = 0;
  root.outside = CellRoot::nowhere;
  if (last == 0) return;

  const PowerCubic cubic(f);
  double low = 0, high = last; // f(low) > 0 >= f(high)
  const double f_high = cubic(high);
  // A minimum that just touches 0 is the root, and so is the end if f comes down to it; else f(1) = 0 is the
  // end of a stretch below 0 whose beginning is looked for.
  if (f_high == 0 && (last < 1 || cubic.slope(1) < 0)) low = high;
  double s = f_high < 0 ? high * (f.start / (f.start - f_high)) : 0.5 * (low + high);
  // 2^-40 of a cell's chord is below 10^-12 voxel. A Newton step of length m leaves an error of m^2 |f''| / 2
  // |f'| at the most, so there is no need to wait for a step that short. 64 steps are more than bisection
  // alone would take.
  const double curvature = std::fabs(cubic.c2) + 3 * std::fabs(cubic.c3); // >= |f''| / 2 on [0,1]
  for (int step = 0; step < 64 && low < high; ++step) {
    const double value = cubic(s), slope = cubic.slope(s);
    if (value == 0) break;
    if (value > 0)
      low = s;
    else
      high = s;
    double next = s - value / slope;
    const double moved = next - s;
    const bool newton = next > low && next < high;
    if (!newton) next = 0.5 * (low + high);
    s = next;
    if ((newton && moved * moved * curvature <= 0x1p-41 * std::fabs(slope)) || high - low <= 0x1p-40) break;
  }
  root.at = s;

  for (const double back : {0x1p-20, 0x1p-10, 1.0}) {
    const double before = std::max(0.0, s - back);
    if (cubic(before) > margin) {
      root.outside = before;
      return;
    }
  }
}

} // namespace levelray
