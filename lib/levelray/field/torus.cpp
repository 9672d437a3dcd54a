#include "levelray/field/torus.hpp"

#include "levelray/field/polynomial_roots.hpp"

namespace levelray {

Vec3d Torus::gradient(const Vec3d& p) const {
  const Vec3d q = frame.to_local(p);
  const double r = std::sqrt(q.x * q.x + q.y * q.y);
  const double away = r > 0 ? (r - radius) / r : 0; // on the axis every direction is as good
  return frame.to_world_direction(Vec3d(q.x * away, q.y * away, q.z).normalized());
}

Chord Torus::chord(const WorldRay& ray) const {
  // With a unit direction, from the point nearest to the centre: the torus lies within its outer radius of
  // it.
  const ExtendedLine line = frame.local_line(ray);
  const Extended length = std::sqrt(line.direction.dot(line.direction));
  const Vec3x d = line.direction / length;
  const Extended shift = -line.origin.dot(d);
  const Vec3x o = line.origin + d * shift;
  const Extended R = radius, r = tube, outer = R + r;
  const Extended reach2 = outer * outer - o.dot(o);
  if (!(reach2 > 0)) return {};
  const Extended reach = std::sqrt(reach2) * (1 + 0x1p-40L); // the ends are proper outside

  // o.d is 0 but for rounding, so the line's square is t^2 + o.o.
  const Extended k = o.dot(o) + R * R - r * r, four = 4 * R * R;
  const Quartic quartic{k * k - four * (o.x * o.x + o.y * o.y), -2 * four * (o.x * d.x + o.y * d.y),
                        2 * k - four * (d.x * d.x + d.y * d.y), 0, 1};
  const Crossings roots = crossings_of(quartic, -reach, reach);

  // The roots are entries and exits in turns; take the first stretch that ends behind the ray's beginning.
  Stretch inside;
  for (std::size_t i = 0; i + 1 < roots.at.size(); i += 2) {
    const Stretch next{(roots.at[i] + shift) / length, (roots.at[i + 1] + shift) / length};
    if (next.high < Extended(ray.t_min)) continue;
    inside = next;
    break;
  }
  Chord chord = certified_chord(*this, ray, inside, radius + tube + frame.centre.length());
  if (roots.undecided) chord.kind = Chord::Kind::undecided;
  return chord;
}

double Torus::curvature(const Vec3d& p, double reach) const {
  const Vec3d q = frame.to_local(p);
  const double s = value(p) + tube - reach, r = std::sqrt(q.x * q.x + q.y * q.y) - reach;
  return s > 0 && r > 0 ? 1 / s + 1 / r : kinked;
}

} // namespace levelray
