// Rotation, uniform scale and translation: what places an object in the world.
#pragma once

#include "levelray/core/ray.hpp"

namespace levelray {

// Maps p to translation + scale * (x_axis p.x + y_axis p.y + z_axis p.z). The axes, where those of the object
// go, are orthonormal and right-handed; scale > 0.
//
// Distances grow by `scale` and angles stay, so a signed distance field remains one, and a ray may be moved
// to the object: its t is the same number there, because the direction is scaled with it.
struct Similarity {
  Vec3d x_axis{1, 0, 0}, y_axis{0, 1, 0}, z_axis{0, 0, 1};
  Vec3d translation{0, 0, 0}; // world units
  double scale = 1;

  static Similarity translated(const Vec3d& by);
  static Similarity scaled(double by);
  // Counter-clockwise as seen from the tip of `axis`, which may have any length but 0 (Rodrigues 1840).
  static Similarity rotated(const Vec3d& axis, double degrees);

  bool is_identity() const;

  // Of a point, of a difference of points, of a unit direction or normal (which keeps its length).
  Vec3d point(const Vec3d& p) const { return translation + rotate(p) * scale; }
  Vec3d vector(const Vec3d& v) const { return rotate(v) * scale; }
  Vec3d rotate(const Vec3d& v) const { return x_axis * v.x + y_axis * v.y + z_axis * v.z; }
  // The ray with the same t at each of its points. The identity gives the same bits, -0 included.
  WorldRay ray(const WorldRay& r) const;

  Similarity inverse() const;
  // The smallest box around the image of a box; an empty one stays empty.
  Box3d box(const Box3d& b) const;
};

// First b, then a.
Similarity operator*(const Similarity& a, const Similarity& b);

// Throws Error(usage) unless everything is finite, scale > 0, and the axes are orthonormal and right-handed
// to 1e-9, which bends distances by as much.
void check_similarity(const Similarity& s);

} // namespace levelray
