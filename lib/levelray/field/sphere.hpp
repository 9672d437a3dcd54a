// A ball: |p - c| - r.
#pragma once

#include "levelray/field/field.hpp"

namespace levelray {

struct Sphere {
  static constexpr bool is_distance = true, smooth = true;

  Vec3d centre{0, 0, 0};
  double radius = 1;

  template <class Number>
  Number value(const Imath::Vec3<Number>& p) const {
    const Imath::Vec3<Number> q = p - Imath::Vec3<Number>(centre);
    return std::sqrt(q.dot(q)) - Number(radius);
  }
  Vec3d gradient(const Vec3d& p) const { return (p - centre).normalized(); }
  Chord chord(const WorldRay& ray) const {
    return certified_chord(*this, ray, stretch(line_of(ray), centre, radius), radius + centre.length());
  }
  // Both principal curvatures of the parallel sphere at distance s from the centre are 1/s.
  double curvature(const Vec3d& p, double reach) const {
    const double nearest = (p - centre).length() - reach;
    return nearest > 0 ? 2 / nearest : kinked;
  }
  Box3d bounds() const {
    const Vec3d r(radius, radius, radius);
    return Box3d(centre - r, centre + r);
  }

  // The part of a line within `radius` of `centre`. Measured from the point nearest to the centre, so that
  // far origins cost no digits: the discriminant is r^2 less the squared distance of the line.
  static Stretch stretch(const ExtendedLine& line, const Vec3d& centre, double radius) {
    const Vec3x o = line.origin - Vec3x(centre);
    const Extended a = line.direction.dot(line.direction);
    const Extended nearest = -o.dot(line.direction) / a;
    const Vec3x foot = o + line.direction * nearest;
    const Extended rest = Extended(radius) * radius - foot.dot(foot);
    if (!(rest >= 0)) return {};
    const Extended half = std::sqrt(rest / a);
    return {nearest - half, nearest + half};
  }
};

} // namespace levelray
