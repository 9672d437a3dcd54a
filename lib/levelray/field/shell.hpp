// A hollow ball: all points within half a thickness of a sphere. Its distance is ||p - c| - R| - w/2.
#pragma once

#include "levelray/field/sphere.hpp"

namespace levelray {

struct Shell {
  static constexpr bool is_distance = true, smooth = true;

  Vec3d centre{0, 0, 0};
  double radius = 1, thickness = 0.1; // of the middle; whole

  template <class Number>
  Number value(const Imath::Vec3<Number>& p) const {
    const Imath::Vec3<Number> q = p - Imath::Vec3<Number>(centre);
    return std::fabs(std::sqrt(q.dot(q)) - Number(radius)) - Number(thickness) / 2;
  }
  Vec3d gradient(const Vec3d& p) const {
    const Vec3d out = (p - centre).normalized();
    return (p - centre).length() < radius ? -out : out;
  }
  // From outside: into the outer ball, and out of it or into the hollow. From the hollow: out of the hollow.
  Chord chord(const WorldRay& ray) const {
    const ExtendedLine line = line_of(ray);
    const Stretch outer = Sphere::stretch(line, centre, radius + thickness / 2);
    const Stretch hollow = Sphere::stretch(line, centre, radius - thickness / 2);
    Stretch first = outer;
    if (!hollow.empty()) {
      if (Extended(ray.t_min) < hollow.low)
        first.high = hollow.low;
      else
        first.low = hollow.high;
    }
    return certified_chord(*this, ray, first, radius + thickness + centre.length());
  }
  // The distance has a kink in the middle.
  double curvature(const Vec3d& p, double reach) const {
    const double s = (p - centre).length(), nearest = s - reach;
    return nearest > 0 && std::fabs(s - radius) > reach ? 2 / nearest : kinked;
  }
  Box3d bounds() const {
    const double r = radius + thickness / 2;
    return Box3d(centre - Vec3d(r, r, r), centre + Vec3d(r, r, r));
  }
};

} // namespace levelray
