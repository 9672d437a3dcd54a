// A torus: all points within the tube's radius of a circle.
#pragma once

#include "levelray/field/frame.hpp"

namespace levelray {

struct Torus {
  static constexpr bool is_distance = true, smooth = true;

  Frame frame; // the circle lies in the plane z = 0 around the centre
  double radius = 1, tube = 0.25;

  template <class Number>
  Number value(const Imath::Vec3<Number>& p) const {
    const Imath::Vec3<Number> q = frame.to_local(p);
    const Number r = std::sqrt(q.x * q.x + q.y * q.y) - Number(radius);
    return std::sqrt(r * r + q.z * q.z) - Number(tube);
  }
  Vec3d gradient(const Vec3d& p) const;
  // The quartic (|p|^2 + R^2 - r^2)^2 - 4 R^2 (x^2 + y^2) along the ray, its roots isolated.
  Chord chord(const WorldRay& ray) const;
  // At distance s from the circle and r from the axis: 1/s around the tube, and around the axis the cosine of
  // the normal's elevation over r, at most 1/r.
  double curvature(const Vec3d& p, double reach) const;
  Box3d bounds() const { return frame.bounds(Vec3d(radius + tube, radius + tube, tube)); }
};

} // namespace levelray
