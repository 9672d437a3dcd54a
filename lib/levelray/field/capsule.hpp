// All points within a radius of a segment: a cylinder with round ends.
#pragma once

#include "levelray/field/frame.hpp"
#include "levelray/field/sphere.hpp"

#include <algorithm>

namespace levelray {

// Convex, so that the parts of a line in its cylinder and its two balls make one stretch.
struct Capsule {
  static constexpr bool is_distance = true, smooth = true;

  Frame frame; // the segment lies on its z axis
  double half_length = 1, radius = 0.5;

  template <class Number>
  Number value(const Imath::Vec3<Number>& p) const {
    Imath::Vec3<Number> q = frame.to_local(p);
    q.z -= std::clamp(q.z, -Number(half_length), Number(half_length));
    return std::sqrt(q.dot(q)) - Number(radius);
  }
  Vec3d gradient(const Vec3d& p) const {
    Vec3d q = frame.to_local(p);
    q.z -= std::clamp(q.z, -half_length, half_length);
    return frame.to_world_direction(q.normalized());
  }
  Chord chord(const WorldRay& ray) const {
    const ExtendedLine line = frame.local_line(ray);
    const Vec3d end(0, 0, half_length);
    const Stretch inside = joined(
        cylinder(line), joined(Sphere::stretch(line, end, radius), Sphere::stretch(line, -end, radius)));
    return certified_chord(*this, ray, inside, half_length + radius + frame.centre.length());
  }
  // 1/s along the cylinder at distance s from the segment, twice 1/s around the balls.
  double curvature(const Vec3d& p, double reach) const {
    const double nearest = value(p) + radius - reach;
    return nearest > 0 ? 2 / nearest : kinked;
  }
  Box3d bounds() const {
    Vec3d e;
    for (int a = 0; a < 3; ++a) e[a] = std::fabs(frame.axis[2][a]) * half_length + radius;
    return Box3d(frame.centre - e, frame.centre + e);
  }

 private:
  Stretch cylinder(const ExtendedLine& line) const {
    const Vec3x o(line.origin.x, line.origin.y, 0), d(line.direction.x, line.direction.y, 0);
    const Stretch ends =
        between(line.origin.z, line.direction.z, -Extended(half_length), Extended(half_length));
    if (d.dot(d) == 0) return o.dot(o) <= Extended(radius) * radius ? ends : Stretch{};
    return intersection(Sphere::stretch({o, d}, Vec3d(0, 0, 0), radius), ends);
  }
};

} // namespace levelray
