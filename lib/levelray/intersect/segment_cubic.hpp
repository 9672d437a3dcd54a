// The cubic along a segment, positive on the side where the ray began, and brackets of its roots.
#pragma once

#include "levelray/intersect/bernstein.hpp"
#include "levelray/intersect/cell_root.hpp"

#include <algorithm>
#include <cmath>

namespace levelray {

// side * f at fraction s of the segment. Values at the ends are those of `interpolate`, bit for bit, so that
// cells agree on a shared face.
struct SegmentCubic : PowerCubic {
  Bernstein<double> f; // times side
  double margin;       // safety_margin

  SegmentCubic(const CellSegment& segment, double side)
      : SegmentCubic(oriented(segment, side), safety_margin(segment)) {}

  // The places in (0,1) where the slope changes its sign, ascending; returns how many there are. The
  // quadratic formula in the form without cancellation.
  int extrema(double (&at)[2]) const {
    const double half = c2, discriminant = half * half - 3 * c3 * c1;
    if (!(discriminant > 0)) return 0; // a double root of the slope is no extremum
    const double q = -(half + std::copysign(std::sqrt(discriminant), half));
    const double roots[2] = {q / (3 * c3), c1 / q};
    int count = 0;
    for (const double root : roots)
      if (root > 0 && root < 1) at[count++] = root; // not where 3 c3 is 0 or NaN is about
    if (count == 2 && at[1] < at[0]) std::swap(at[0], at[1]);
    return count;
  }

 private:
  SegmentCubic(const Bernstein<double>& along, double safe) : PowerCubic(along), f(along), margin(safe) {}
};

// f(low) > 0 >= f(high).
struct RootBracket {
  double low, high, f_low, f_high;

  // Where the line through both ends is 0; the middle where numbers are too large to say.
  double false_position() const {
    const double at = low + (high - low) * (f_low / (f_low - f_high));
    return at >= low && at <= high ? at : 0.5 * (low + high);
  }
  void narrow(double at, double value) {
    if (value > 0)
      low = at, f_low = value;
    else
      high = at, f_high = value;
  }
};

// The stretch between neighbouring ones of `from`, the cubic's extrema behind it and the end that holds the
// first root behind `from`, where f is `value` > 0. f is monotone there, so the root is the only one; a local
// minimum that just touches 0 is the high end. Returns false where there is no root.
inline bool first_bracket(const SegmentCubic& cubic, double from, double value, RootBracket& bracket) {
  bracket.low = from, bracket.f_low = value;
  double extrema[2];
  const int count = cubic.extrema(extrema);
  for (int i = 0; i < count; ++i) {
    if (!(extrema[i] > bracket.low)) continue;
    const double here = cubic(extrema[i]);
    if (here <= 0) {
      bracket.high = extrema[i], bracket.f_high = here;
      return true;
    }
    bracket.low = extrema[i], bracket.f_low = here;
  }
  bracket.high = 1, bracket.f_high = cubic.f.end;
  return bracket.f_high <= 0;
}

// Newton's method from the false position. The bracket is kept: a step that would leave it is replaced by
// its middle. Stops where a step is below 2^-36 of the segment, 2 * 10^-11 voxel; 64 steps are more than
// bisection alone would take. Returns the root; bracket.low is the last place known to lie before it.
inline double newton_in_bracket(const SegmentCubic& cubic, RootBracket& bracket) {
  double s = bracket.false_position();
  for (int step = 0; step < 64; ++step) {
    const double value = cubic(s);
    bracket.narrow(s, value);
    if (value == 0) break;
    double next = s - value / cubic.slope(s);
    if (!(next > bracket.low && next < bracket.high)) next = 0.5 * (bracket.low + bracket.high);
    const double moved = std::fabs(next - s);
    s = next;
    if (!(moved > 0x1p-36)) break;
  }
  return s;
}

} // namespace levelray
