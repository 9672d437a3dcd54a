// A sheet around the gyroid, cut off by a ball.
//
// The solid is |g(k p)| <= level within the ball, g(x,y,z) = sin x cos y + sin y cos z + sin z cos x (Schoen
// 1970). There is no closed form of the distance to it. value() is
//   max((|g(k (p - c))| - level) / (k sqrt(3)), |p - c| - ball),
// exact in sign and zero set, and no larger than the distance: by Cauchy and Schwarz |g_x| = |cos x cos y -
// sin z sin x| <= sqrt(cos^2 y + sin^2 z), and the three squares add up to 3 at most, so |grad g| <= sqrt(3)
// (met at the origin). On the sheet |grad value| is between 0.6 and 1 for the levels used here.
#pragma once

#include "levelray/field/field.hpp"

namespace levelray {

struct Gyroid {
  static constexpr bool is_distance = false, smooth = false; // the ball's rim is sharp

  Vec3d centre{0, 0, 0};
  double ball = 1, frequency = 6, level = 0.3; // frequency k: radians per world unit

  template <class Number>
  Number value(const Imath::Vec3<Number>& p) const {
    const Imath::Vec3<Number> q = p - Imath::Vec3<Number>(centre);
    const Number sheet = (std::fabs(wave(q * Number(frequency))) - Number(level)) / steepest<Number>();
    return std::max(sheet, std::sqrt(q.dot(q)) - Number(ball));
  }
  Vec3d gradient(const Vec3d& p) const;
  // Along a ray g is half a sum of six sines of linear functions, sin a cos b = (sin(a+b) + sin(a-b)) / 2.
  // Its first roots are isolated by bounds from Taylor's theorem with the six second derivatives.
  Chord chord(const WorldRay& ray) const;
  // Away from the kinks (g = 0, the ball's rim) |g_xx| = |sin x cos y + sin z cos x| <= sqrt(cos^2 y + sin^2
  // z), so the three add up to at most 3 k^2: as above, sum of three numbers whose squares add up to 3.
  double curvature(const Vec3d& p, double reach) const;
  Box3d bounds() const {
    const Vec3d r(ball, ball, ball);
    return Box3d(centre - r, centre + r);
  }

 private:
  template <class Number>
  static Number wave(const Imath::Vec3<Number>& u) {
    return std::sin(u.x) * std::cos(u.y) + std::sin(u.y) * std::cos(u.z) + std::sin(u.z) * std::cos(u.x);
  }
  template <class Number>
  Number steepest() const { // of g(k p)
    return Number(frequency) * std::sqrt(Number(3));
  }
};

} // namespace levelray
