#include "levelray/field/gyroid.hpp"

#include "levelray/field/sine_sum.hpp"
#include "levelray/field/sphere.hpp"

namespace levelray {

Vec3d Gyroid::gradient(const Vec3d& p) const {
  const Vec3d q = p - centre, u = q * frequency;
  const double g = wave(u), sheet = (std::fabs(g) - level) / steepest<double>();
  if (q.length() - ball > sheet) return q.normalized();
  const Vec3d slope(std::cos(u.x) * std::cos(u.y) - std::sin(u.z) * std::sin(u.x),
                    std::cos(u.y) * std::cos(u.z) - std::sin(u.x) * std::sin(u.y),
                    std::cos(u.z) * std::cos(u.x) - std::sin(u.y) * std::sin(u.z));
  return (g < 0 ? -slope : slope).normalized();
}

Chord Gyroid::chord(const WorldRay& ray) const {
  const ExtendedLine line = line_of(ray);
  const Stretch within =
      intersection(Sphere::stretch(line, centre, ball), {Extended(ray.t_min), Extended(ray.t_max)});
  if (within.empty()) return {};

  // Times are counted from the entry into the ball, where phases are small.
  const Vec3x u = (line.at(within.low) - Vec3x(centre)) * Extended(frequency);
  const Vec3x du = line.direction * Extended(frequency);
  SineSum sum;
  for (std::size_t a = 0; a < 3; ++a) {
    const int i = static_cast<int>(a), j = (i + 1) % 3;
    sum.phase[2 * a] = u[i] + u[j], sum.rate[2 * a] = du[i] + du[j];
    sum.phase[2 * a + 1] = u[i] - u[j], sum.rate[2 * a + 1] = du[i] - du[j];
  }
  const Extended length = within.high - within.low, start = sum.value(0);

  // In: at once, on the ball's surface, or where |g| first comes down to the level.
  Stretch inside;
  Extended entry = 0;
  bool undecided = std::fabs(std::fabs(start) - Extended(level)) < 0x1p-50L;
  if (std::fabs(start) <= Extended(level)) {
    inside.low = within.low > Extended(ray.t_min) ? within.low : -std::numeric_limits<Extended>::infinity();
  } else {
    sum.level = start > 0 ? Extended(level) : -Extended(level);
    const FirstRoot root = first_root(sum, 0, length);
    undecided = undecided || root.undecided;
    if (!root.at) return undecided ? Chord{Chord::Kind::undecided} : Chord{};
    entry = *root.at;
    inside.low = within.low + entry;
  }
  // Out: where |g| first comes up to the level again, or with the ball. The search begins behind the entry by
  // more than its rounding.
  inside.high = within.high;
  for (const double side : {1.0, -1.0}) {
    sum.level = Extended(level) * side;
    const FirstRoot root = first_root(sum, entry + length * 0x1p-40L, length);
    if (root.at) inside.high = std::min(inside.high, within.low + *root.at);
  }
  Chord chord = certified_chord(*this, ray, inside, ball + centre.length());
  if (undecided && chord) chord.kind = Chord::Kind::undecided;
  return chord;
}

double Gyroid::curvature(const Vec3d& p, double reach) const {
  const Vec3d q = p - centre;
  const double height = std::fabs(wave(q * frequency)) / steepest<double>(); // changes by <= 1 per unit
  const double sheet = height - level / steepest<double>(), round = q.length() - ball;
  if (std::fabs(sheet - round) <= 2 * reach) return kinked;
  if (round > sheet) return q.length() > reach ? 2 / (q.length() - reach) : kinked;
  return height > reach ? 3 * frequency * frequency / steepest<double>() : kinked;
}

} // namespace levelray
