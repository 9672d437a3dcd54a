// Segments of made-up cells, and what is true of them.
#pragma once

#include "support/reference_tracer.hpp"

#include "levelray/grid/cell_segment.hpp"

#include <array>
#include <random>

namespace levelray::test {

inline CellPoint cell_point(double x, double y, double z) {
  CellPoint p;
  const double c[3] = {x, y, z};
  for (int a = 0; a < 3; ++a) p.x[a] = c[a], p.rest[a] = 1 - c[a];
  return p;
}

inline CellSegment cell_segment(const std::array<float, 8>& corner, CellPoint in, CellPoint out) {
  CellSegment s;
  float largest = 0;
  for (int c = 0; c < 8; ++c) {
    s.corner[c] = corner[static_cast<std::size_t>(c)];
    largest = std::max(largest, std::fabs(s.corner[c]));
  }
  s.error = largest * 0x1p-20f + 0x1p-120f; // as SurfaceBlocks sets it
  s.in = in;
  s.out = out;
  return s;
}

// The segment's cubic in s from 0 to 1, its largest corner, and what its values may be off by when computed
// in double: the bound of bernstein.hpp, 16 * 2^-53 of the largest corner, and as much again for evaluating
// it at the minimum.
struct SegmentOracle {
  CellCubic cubic;
  Real largest = 0, doubt;

  explicit SegmentOracle(const CellSegment& s) : cubic(make(s)) {
    for (const float c : s.corner) largest = std::max<Real>(largest, std::fabs(c));
    doubt = 32 * 0x1p-53L * largest;
  }
  static CellCubic make(const CellSegment& s) {
    Real o[3], d[3];
    for (int a = 0; a < 3; ++a) o[a] = s.in.x[a], d[a] = Real(s.out.x[a]) - s.in.x[a];
    return CellCubic(s.corner, o, d);
  }
  Real slope(Real s) const { return cubic.c[1] + s * (2 * cubic.c[2] + s * 3 * cubic.c[3]); }
};

// Cells whose corners are all of one decade, or each of its own, or a tilted plane, nearly flat, so that
// roots are doubtful; with chords from face to face, or short, or along an axis. All over 16 decades.
class RandomSegments {
 public:
  explicit RandomSegments(unsigned seed) : engine_(seed) {}

  CellSegment next() {
    std::array<float, 8> corner;
    const double scale = std::pow(10, within(-8, 8));
    const double a = within(-1, 1), b = within(-1, 1), c = within(-1, 1), e = within(-2, 2);
    const double bend = std::pow(10, within(-8, 0));
    const int shape = count_++ % 3;
    for (int k = 0; k < 8; ++k) {
      const double noise = within(-1, 1);
      const double value = shape == 0 ? scale * noise
                           : shape == 1
                               ? noise * std::pow(10, within(-8, 8))
                               : scale * (a * (k & 1) + b * (k >> 1 & 1) + c * (k >> 2) + e + bend * noise);
      corner[static_cast<std::size_t>(k)] = static_cast<float>(value);
    }
    double in[3], out[3];
    for (int k = 0; k < 3; ++k) in[k] = unit_(engine_), out[k] = unit_(engine_);
    const int axis = static_cast<int>(3 * unit_(engine_)), kind = static_cast<int>(4 * unit_(engine_));
    if (kind < 2) in[axis] = 0, out[(axis + kind) % 3] = 1;
    if (kind == 2)
      for (int k = 0; k < 3; ++k) out[k] = std::clamp(in[k] + 1e-3 * (out[k] - in[k]), 0.0, 1.0);
    if (kind == 3)
      for (int k = 0; k < 3; ++k) in[k] = k == axis ? 0 : in[k], out[k] = k == axis ? 1 : in[k];
    return cell_segment(corner, cell_point(in[0], in[1], in[2]), cell_point(out[0], out[1], out[2]));
  }

 private:
  double within(double low, double high) { return low + (high - low) * unit_(engine_); }

  std::mt19937_64 engine_;
  std::uniform_real_distribution<double> unit_{0, 1};
  int count_ = 0;
};

} // namespace levelray::test
