#include "levelray/intersect/exact.hpp"

#include <algorithm>

namespace levelray {

namespace {

// The cubic and its derivative in the power basis: one sum fewer per evaluation, and equally good in double.
struct Cubic {
  double c0, c1, c2, c3;

  explicit Cubic(const Bernstein<double>& f)
      : c0(f.b[0]), c1(3 * (f.b[1] - f.b[0])), c2(3 * ((f.b[2] - f.b[1]) - (f.b[1] - f.b[0]))),
        c3((f.b[3] - f.b[0]) - 3 * (f.b[2] - f.b[1])) {}
  double operator()(double s) const { return ((c3 * s + c2) * s + c1) * s + c0; }
  double slope(double s) const { return (3 * c3 * s + 2 * c2) * s + c1; }
};

// By de Casteljau's scheme: convex combinations only, so the rounding is that of the coefficients.
double evaluate(const Bernstein<double>& f, double s) {
  const double r = 1 - s;
  const double p0 = f.b[0] * r + f.b[1] * s, p1 = f.b[1] * r + f.b[2] * s, p2 = f.b[2] * r + f.b[3] * s;
  const double q0 = p0 * r + p1 * s, q1 = p1 * r + p2 * s;
  return q0 * r + q1 * s;
}

// Where the cubic has its local minimum, if that is in (0,1); else -1. With the derivative's Bernstein
// coefficients d0, d1, d2 (a third of them) it is A s^2 + 2 B s + C, A = d0 - 2 d1 + d2, B = d1 - d0, C = d0,
// and grows at (-B + sqrt(B^2 - A C)) / A.
double local_minimum(const Bernstein<double>& f) {
  const double d0 = f.b[1] - f.b[0], d1 = f.b[2] - f.b[1], d2 = f.b[3] - f.b[2];
  const double discriminant = d1 * d1 - d0 * d2; // B^2 - A C, where most terms cancel exactly
  if (!(discriminant >= 0)) return -1;
  const double root = std::sqrt(discriminant), half = d1 - d0;
  const double s = half <= 0 ? (root - half) / (d0 - d1 + (d2 - d1)) : -d0 / (half + root);
  return s > 0 && s < 1 ? s : -1;
}

} // namespace

double Exact::last_of_bracket(const Bernstein<double>& f) {
  const auto& b = f.b;
  if (!(b[0] > 0)) return 0;
  const bool ends = b[3] <= 0;
  // One change of sign: one root. A minimum can only matter where the middle coefficients dip and come back.
  if (ends && (b[1] > 0 || b[2] <= 0)) return 1;
  if (!ends && b[1] > 0 && b[2] > 0) return -1;
  const double minimum = local_minimum(f);
  if (minimum > 0 && evaluate(f, minimum) <= 0) return minimum;
  return ends ? 1 : -1;
}

// Newton's method from the false position, kept inside the bracket by bisection.
void Exact::polish(const Bernstein<double>& f, double last, CellRoot& root) {
  root.at = 0;
  root.outside = CellRoot::nowhere;
  if (last == 0) return;

  const Cubic cubic(f);
  double low = 0, high = last; // f(low) > 0 >= f(high)
  const double f_high = cubic(high);
  double s = f_high < 0 ? high * (f.b[0] / (f.b[0] - f_high)) : 0.5 * high;
  // 2^-40 of a cell's chord is below 10^-12 voxel. 64 steps are more than bisection alone would need.
  for (int step = 0; step < 64; ++step) {
    const double value = cubic(s);
    if (value > 0)
      low = s;
    else
      high = s;
    double next = s - value / cubic.slope(s);
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    const double moved = std::fabs(next - s);
    s = next;
    if (moved <= 0x1p-40 || high - low <= 0x1p-40) break;
  }
  root.at = s;

  // A start for secondary rays. They compute their point anew, from world coordinates, with an error of some
  // 2^-53 of the grid's size in voxels, so f must exceed that: 2^-36 of the largest coefficient serves grids
  // of 2^14 voxels and more.
  const double margin =
      0x1p-36 * std::max({std::fabs(f.b[0]), std::fabs(f.b[1]), std::fabs(f.b[2]), std::fabs(f.b[3])});
  for (const double back : {0x1p-20, 0x1p-10, 1.0}) {
    const double before = std::max(0.0, s - back);
    if (cubic(before) > margin) {
      root.outside = before;
      return;
    }
  }
}

} // namespace levelray
