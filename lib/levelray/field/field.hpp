// What an analytic field is: a shape whose distance, normals and ray hits are known without any grid.
//
// A field is a struct with
//   static constexpr std::string_view name, source; // of the named shapes (reference_shapes.hpp)
//   static constexpr bool is_distance; // value() is the signed Euclidean distance; else it has the
//   distance's
//                                      // sign and is no larger: |value| <= distance
//   static constexpr bool smooth;      // the surface has a normal everywhere, which turns at a finite rate
//   template <class Extended> Extended value(const Imath::Vec3<Extended>& p) const; // world units, negative
//   inside; changes
//                                      // by no more than |p - q| from p to q (is 1-Lipschitz)
//   Vec3d gradient(const Vec3d& p) const; // of unit length; where value() has a kink, of one of its sides
//   Chord chord(const WorldRay&) const;   // where a ray first enters, and where it leaves again
//   double curvature(const Vec3d& p, double radius) const; // see below
//   Box3d bounds() const;                 // of the solid, which is finite
//
// curvature(p, radius): a bound of |f_xx| + |f_yy| + |f_zz| over the ball of that radius around p, infinite
// where value() has a kink in it. For a distance the eigenvalues of its second derivatives are those of the
// parallel surface, k1, k2 and 0, and the sum over any three axes e of |e.H e| is at most |k1| + |k2|.
//
// Chords come from closed forms or from isolated roots in long double, and share no code with the tracer.
#pragma once

#include "levelray/core/ray.hpp"
#include "levelray/core/vec.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace levelray {

using Extended = long double; // of the references: 64 bits of mantissa on x86-64
using Vec3x = Imath::Vec3<Extended>;

inline constexpr double kinked = std::numeric_limits<double>::infinity();

// The first stretch of a ray in a solid.
struct Chord {
  enum class Kind : std::uint8_t {
    miss,
    hit,
    undecided // touched or missed: too close for the arithmetic to tell
  };
  Kind kind = Kind::miss;
  double enter = 0; // t; the ray's beginning when that is inside
  double error =
      0;           // the true entry lies in [enter - error, enter + error]: proven by the field's signs there
  double exit = 0; // t, rounded

  explicit operator bool() const { return kind == Kind::hit; }
};

// A closed interval of a line; empty when low > high. Of solids that are the intersection of simpler ones.
struct Stretch {
  Extended low = std::numeric_limits<Extended>::infinity(), high = -std::numeric_limits<Extended>::infinity();

  bool empty() const { return !(low <= high); }
  static Stretch all() {
    return {-std::numeric_limits<Extended>::infinity(), std::numeric_limits<Extended>::infinity()};
  }
};
inline Stretch intersection(const Stretch& a, const Stretch& b) {
  return {std::max(a.low, b.low), std::min(a.high, b.high)};
}
// Of two stretches that overlap or of which one is empty.
inline Stretch joined(const Stretch& a, const Stretch& b) {
  if (a.empty()) return b;
  if (b.empty()) return a;
  return {std::min(a.low, b.low), std::max(a.high, b.high)};
}

// Where a t^2 + 2 b t + c <= 0, for a > 0. Without cancellation: q/a and c/q.
inline Stretch below_zero(Extended a, Extended b, Extended c) {
  const Extended discriminant = b * b - a * c;
  if (!(a > 0) || !(discriminant >= 0)) return {};
  const Extended q = -(b + std::copysign(std::sqrt(discriminant), b));
  const Extended one = q / a, other = q != 0 ? c / q : 0;
  return {std::min(one, other), std::max(one, other)};
}

// Where |o + t d| <= half, along one axis.
inline Stretch between(Extended o, Extended d, Extended low, Extended high) {
  if (d == 0) return o >= low && o <= high ? Stretch::all() : Stretch{};
  const Extended one = (low - o) / d, other = (high - o) / d;
  return {std::min(one, other), std::max(one, other)};
}

// A ray in long double.
struct ExtendedLine {
  Vec3x origin, direction;
  Vec3x at(Extended t) const { return origin + direction * t; }
};
inline ExtendedLine line_of(const WorldRay& ray) {
  return {Vec3x(ray.origin), Vec3x(ray.direction)};
}

// Makes a chord of the first stretch [low, high] of the ray in the solid, and proves its entry: value() is
// positive before and negative behind it, by more than its rounding.
//
// The rounding: value() takes at most some 60 operations on numbers that are no larger than the reach of the
// point and the size of the shape, S in all; each is off by at most 2^-64 of its result, and none amplifies
// the errors before it by more than 2 (square roots of sums of squares). 2^-57 S covers them; t itself is
// rounded to double, 2^-53 of it, which the bracket of 2^-50 S and more holds.
template <class Field>
Chord certified_chord(const Field& field, const WorldRay& ray, const Stretch& stretch, double size) {
  Chord chord;
  const Stretch inside = intersection(stretch, {Extended(ray.t_min), Extended(ray.t_max)});
  if (inside.empty()) return chord;
  chord.enter = static_cast<double>(inside.low);
  chord.exit = static_cast<double>(inside.high);
  chord.kind = Chord::Kind::hit;
  if (inside.low > stretch.low) return chord; // begins inside

  const ExtendedLine line = line_of(ray);
  const Extended length = std::sqrt(line.direction.dot(line.direction)), t = inside.low;
  const Extended scale = std::sqrt(line.origin.dot(line.origin)) + std::fabs(t) * length + size;
  const Extended rounding = 0x1p-57L * scale;
  for (Extended step = 0x1p-50L * scale; step <= 0x1p-20L * scale; step *= 4) {
    if (!(field.value(line.at(t - step / length)) > rounding)) continue;
    if (!(field.value(line.at(t + step / length)) < -rounding)) continue;
    chord.error = static_cast<double>(step / length);
    return chord;
  }
  chord.kind = Chord::Kind::undecided;
  return chord;
}

} // namespace levelray
