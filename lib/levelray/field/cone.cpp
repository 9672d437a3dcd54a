#include "levelray/field/cone.hpp"

namespace levelray {

Vec3d Cone::gradient(const Vec3d& p) const {
  const Vec3d q = frame.to_local(p);
  const Nearest<double> n = nearest(q);
  const double r = std::sqrt(q.x * q.x + q.y * q.y),
               length = std::sqrt(n.out_r * n.out_r + n.out_z * n.out_z);
  double radial, axial;
  if (length > 1e-12 * (height + radius)) {
    radial = n.out_r / length * (n.inside ? -1 : 1), axial = n.out_z / length * (n.inside ? -1 : 1);
  } else if (n.on_side) { // on the surface: the side's normal is across (-R, H)
    const double slant = std::sqrt(radius * radius + height * height);
    radial = height / slant, axial = radius / slant;
  } else {
    radial = 0, axial = -1;
  }
  const Vec3d out = r > 0 ? Vec3d(q.x / r * radial, q.y / r * radial, axial) : Vec3d(0, 0, axial);
  return frame.to_world_direction(out.normalized());
}

// The points of a line with r^2 <= k^2 (h - z)^2, k = R/H, make up one stretch in the half-space under the
// tip, or two half-lines of which one lies there; the plane of the base cuts it off.
Chord Cone::chord(const WorldRay& ray) const {
  const ExtendedLine line = frame.local_line(ray);
  const Extended half = Extended(height) / 2, k2 = Extended(radius) * radius / (Extended(height) * height);
  // From the point nearest to the centre, so that far origins cost no digits.
  const Vec3x& d = line.direction;
  const Extended shift = -line.origin.dot(d) / d.dot(d);
  const Vec3x o = line.at(shift);
  const Extended down = half - o.z; // under the tip
  const Extended a = d.x * d.x + d.y * d.y - k2 * d.z * d.z;
  const Extended b = o.x * d.x + o.y * d.y + k2 * down * d.z;
  const Extended c = o.x * o.x + o.y * o.y - k2 * down * down;
  const Stretch heights = between(o.z, d.z, -half, half);

  Stretch inside;
  if (a > 0) {
    inside = intersection(below_zero(a, b, c), heights);
  } else if (a < 0) {
    // Outside the roots of the parabola: -a t^2 - 2 b t - c >= 0.
    const Stretch gap = below_zero(-a, -b, -c);
    if (gap.empty()) {
      inside = heights; // no root: all of the line is within the double cone
    } else {
      const Stretch before = intersection(heights, {-std::numeric_limits<Extended>::infinity(), gap.low});
      const Stretch behind = intersection(heights, {gap.high, std::numeric_limits<Extended>::infinity()});
      inside = before.empty() ? behind : before;
    }
  } else if (b != 0) {
    const Extended root = -c / (2 * b);
    const Extended infinite = std::numeric_limits<Extended>::infinity();
    inside = intersection(heights, b > 0 ? Stretch{-infinite, root} : Stretch{root, infinite});
  } else if (c <= 0) {
    inside = heights;
  }
  if (!inside.empty()) inside.low += shift, inside.high += shift;
  return certified_chord(*this, ray, inside, height + radius + frame.centre.length());
}

double Cone::curvature(const Vec3d& p, double reach) const {
  const Vec3d q = frame.to_local(p);
  const Nearest<double> n = nearest(q);
  const double r = std::sqrt(q.x * q.x + q.y * q.y), z = q.z + height / 2;
  const double slant = std::sqrt(radius * radius + height * height);
  const double distance = std::sqrt(n.out_r * n.out_r + n.out_z * n.out_z);
  const double edge = n.on_side ? slant : radius;
  const double margin = std::min(n.along, 1 - n.along) * edge; // of the nearest point, to the edge's ends
  if (!n.on_side) {
    // Over all of the ball the base stays nearest when its side is farther by twice the reach; the disc has
    // no edge at the axis.
    const double to_side = std::fabs(r * height + z * radius - radius * height) / slant;
    return (1 - n.along) * radius > reach && to_side - distance > 2 * reach ? 0 : kinked;
  }
  if (!(margin > reach && r > reach)) return kinked;
  if (n.inside && !(std::fabs(z) - distance > 2 * reach)) return kinked;
  return height / slant / (r - reach);
}

} // namespace levelray
