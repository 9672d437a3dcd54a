// A round cone, capped by a flat base.
#pragma once

#include "levelray/field/frame.hpp"

#include <algorithm>

namespace levelray {

// Base of that radius in the plane z = -height/2 of the frame, tip at z = height/2. In the half-plane of
// (distance from the axis, z) it is a triangle; the distance is that to its two sides away from the axis.
struct Cone {
  static constexpr bool is_distance = true, smooth = false;

  Frame frame;
  double height = 1, radius = 0.5;

  template <class Number>
  Number value(const Imath::Vec3<Number>& p) const {
    const Nearest<Number> n = nearest(frame.to_local(p));
    const Number length = std::sqrt(n.out_r * n.out_r + n.out_z * n.out_z);
    return n.inside ? -length : length;
  }
  Vec3d gradient(const Vec3d& p) const;
  Chord chord(const WorldRay& ray) const;
  // Flat under the base and over the side (in the half-plane); the side turns about the axis at the rate
  // cos(a)/r at distance r from it, a being the angle between side and axis.
  double curvature(const Vec3d& p, double reach) const;
  Box3d bounds() const { return frame.bounds(Vec3d(radius, radius, height / 2)); }

 private:
  template <class Number>
  struct Nearest {
    Number out_r, out_z; // from the nearest point of the surface, in the half-plane
    bool inside;
    bool on_side; // the nearest point lies on the side, not on the base
    Number along; // of it on that edge, 0 to 1
  };
  template <class Number>
  Nearest<Number> nearest(const Imath::Vec3<Number>& q) const {
    const Number r = std::sqrt(q.x * q.x + q.y * q.y), R = Number(radius), H = Number(height);
    const Number z = q.z + H / 2; // above the base
    // The base, from the axis to the rim, and the side, from the rim (R, 0) to the tip (0, H).
    const Number base = std::clamp(r, Number(0), R);
    const Number length2 = R * R + H * H;
    const Number side = std::clamp(((r - R) * -R + z * H) / length2, Number(0), Number(1));
    const Number base_r = r - base, base_z = z;
    const Number side_r = r - R * (1 - side), side_z = z - H * side;
    const bool on_side = side_r * side_r + side_z * side_z < base_r * base_r + base_z * base_z;
    // Inside: above the base and under the side's line.
    const bool inside = z > 0 && r * H + z * R < R * H;
    return on_side ? Nearest<Number>{side_r, side_z, inside, true, side}
                   : Nearest<Number>{base_r, base_z, inside, false, base / R};
  }
};

} // namespace levelray
