// Place and orientation of a shape.
#pragma once

#include "levelray/field/field.hpp"

namespace levelray {

// Local coordinates: those along three orthonormal axes, from the centre.
struct Frame {
  Vec3d centre{0, 0, 0};
  Vec3d axis[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

  // The frame whose z axis is that direction (unit length), its others being any.
  static Frame along(const Vec3d& centre, const Vec3d& z) {
    Frame frame;
    frame.centre = centre;
    const Vec3d other = std::fabs(z.x) < 0.6 ? Vec3d(1, 0, 0) : Vec3d(0, 1, 0);
    frame.axis[0] = other.cross(z).normalized();
    frame.axis[1] = z.cross(frame.axis[0]);
    frame.axis[2] = z;
    return frame;
  }

  template <class Number>
  Imath::Vec3<Number> to_local(const Imath::Vec3<Number>& p) const {
    return turned(p - Imath::Vec3<Number>(centre));
  }
  // Of a direction.
  template <class Number>
  Imath::Vec3<Number> turned(const Imath::Vec3<Number>& v) const {
    return {v.dot(Imath::Vec3<Number>(axis[0])), v.dot(Imath::Vec3<Number>(axis[1])),
            v.dot(Imath::Vec3<Number>(axis[2]))};
  }
  Vec3d to_world_direction(const Vec3d& v) const { return axis[0] * v.x + axis[1] * v.y + axis[2] * v.z; }

  ExtendedLine local_line(const WorldRay& ray) const {
    return {to_local(Vec3x(ray.origin)), turned(Vec3x(ray.direction))};
  }
  // The box around what extends so far along the local axes from the centre.
  Box3d bounds(const Vec3d& half) const {
    Vec3d e;
    for (int a = 0; a < 3; ++a)
      e[a] = std::fabs(axis[0][a]) * half.x + std::fabs(axis[1][a]) * half.y + std::fabs(axis[2][a]) * half.z;
    return Box3d(centre - e, centre + e);
  }
};

} // namespace levelray
