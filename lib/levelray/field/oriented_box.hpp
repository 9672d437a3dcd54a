// A box in any orientation, thin ones (slabs) among them.
//
// Its distance: outside the length of what the local coordinates exceed the half sides by, inside the largest
// of the differences to them (Hart 1996, section 3.2, for boxes in this form: Quilez, "distance functions").
#pragma once

#include "levelray/field/frame.hpp"

#include <algorithm>

namespace levelray {

struct OrientedBox {
  static constexpr bool is_distance = true, smooth = false;

  Frame frame;
  Vec3d half{1, 1, 1}; // half sides along the frame's axes

  template <class Number>
  Number value(const Imath::Vec3<Number>& p) const {
    const Imath::Vec3<Number> q = frame.to_local(p);
    Number square = 0, largest = -std::numeric_limits<Number>::infinity();
    for (int a = 0; a < 3; ++a) {
      const Number beyond = std::fabs(q[a]) - Number(half[a]);
      if (beyond > 0) square += beyond * beyond;
      largest = std::max(largest, beyond);
    }
    return square > 0 ? std::sqrt(square) : largest;
  }
  Vec3d gradient(const Vec3d& p) const {
    const Vec3d q = frame.to_local(p);
    Vec3d out(0, 0, 0);
    int nearest = 0;
    for (int a = 0; a < 3; ++a) {
      const double beyond = std::fabs(q[a]) - half[a];
      if (beyond > 0) out[a] = std::copysign(beyond, q[a]);
      if (beyond > std::fabs(q[nearest]) - half[nearest]) nearest = a;
    }
    if (!(out.dot(out) > 0)) out[nearest] = std::copysign(1.0, q[nearest]);
    return frame.to_world_direction(out.normalized());
  }
  Chord chord(const WorldRay& ray) const {
    const ExtendedLine line = frame.local_line(ray);
    Stretch inside = Stretch::all();
    for (int a = 0; a < 3; ++a)
      inside = intersection(
          inside, between(line.origin[a], line.direction[a], -Extended(half[a]), Extended(half[a])));
    return certified_chord(*this, ray, inside, half.length() + frame.centre.length());
  }
  // Flat where one face alone decides the distance all over the ball: p lies over it or under it, farther
  // than `reach` from where another takes over, which is the edges outside and the planes halfway between
  // faces inside; and from the opposite face's half.
  double curvature(const Vec3d& p, double reach) const {
    const Vec3d q = frame.to_local(p);
    for (int a = 0; a < 3; ++a) {
      const double beyond = std::fabs(q[a]) - half[a];
      bool alone = std::fabs(q[a]) > reach;
      for (int b = 0; b < 3; ++b) {
        if (b == a) continue;
        const double other = std::fabs(q[b]) - half[b];
        // Over the ball, `beyond` of each axis changes by at most `reach`.
        alone = alone && other + reach <= 0 && beyond - reach >= other + reach;
      }
      if (alone) return 0;
    }
    return kinked;
  }
  Box3d bounds() const { return frame.bounds(half); }
};

} // namespace levelray
