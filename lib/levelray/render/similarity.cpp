#include "levelray/render/similarity.hpp"

#include "levelray/core/error.hpp"

#include <cmath>
#include <numbers>

namespace levelray {

Similarity Similarity::translated(const Vec3d& by) {
  Similarity s;
  s.translation = by;
  return s;
}

Similarity Similarity::scaled(double by) {
  Similarity s;
  s.scale = by;
  return s;
}

Similarity Similarity::rotated(const Vec3d& axis, double degrees) {
  if (!(axis.length() > 0) || !std::isfinite(axis.length()) || !std::isfinite(degrees))
    throw Error(ErrorKind::usage, "a rotation needs an axis other than 0 and a finite angle");
  const Vec3d a = axis.normalized();
  // Quarter turns are exact: sine and cosine of multiples of pi/2 are not.
  const double quarters = degrees / 90;
  const bool exact = quarters == std::floor(quarters) && std::fabs(quarters) < 1e15;
  const auto turn = [&](double sine_at[4], double value) {
    const double rest = std::fmod(quarters, 4);
    return exact ? sine_at[static_cast<int>(rest < 0 ? rest + 4 : rest)] : value;
  };
  double sines[4] = {0, 1, 0, -1}, cosines[4] = {1, 0, -1, 0};
  const double radians = std::fmod(degrees, 360) * (std::numbers::pi / 180);
  const double sine = turn(sines, std::sin(radians)), cosine = turn(cosines, std::cos(radians));
  const auto rotate = [&](const Vec3d& v) {
    return v * cosine + a.cross(v) * sine + a * (a.dot(v) * (1 - cosine));
  };
  Similarity s;
  s.x_axis = rotate(s.x_axis), s.y_axis = rotate(s.y_axis), s.z_axis = rotate(s.z_axis);
  return s;
}

bool Similarity::is_identity() const {
  const Similarity none;
  return x_axis == none.x_axis && y_axis == none.y_axis && z_axis == none.z_axis &&
         translation == none.translation && scale == 1;
}

WorldRay Similarity::ray(const WorldRay& r) const {
  if (is_identity()) return r;
  WorldRay moved = r;
  moved.origin = point(r.origin);
  moved.direction = vector(r.direction);
  return moved;
}

Similarity Similarity::inverse() const {
  // The rotation's inverse is its transpose.
  Similarity s;
  s.x_axis = Vec3d(x_axis.x, y_axis.x, z_axis.x);
  s.y_axis = Vec3d(x_axis.y, y_axis.y, z_axis.y);
  s.z_axis = Vec3d(x_axis.z, y_axis.z, z_axis.z);
  s.scale = 1 / scale;
  s.translation = s.vector(-translation);
  return s;
}

Box3d Similarity::box(const Box3d& b) const {
  Box3d image;
  if (b.isEmpty()) return image;
  for (int c = 0; c < 8; ++c)
    image.extendBy(
        point(Vec3d(c & 1 ? b.max.x : b.min.x, c & 2 ? b.max.y : b.min.y, c & 4 ? b.max.z : b.min.z)));
  return image;
}

Similarity operator*(const Similarity& a, const Similarity& b) {
  Similarity s;
  s.x_axis = a.rotate(b.x_axis), s.y_axis = a.rotate(b.y_axis), s.z_axis = a.rotate(b.z_axis);
  s.translation = a.point(b.translation);
  s.scale = a.scale * b.scale;
  return s;
}

void check_similarity(const Similarity& s) {
  const auto near = [](double value, double wanted) { return std::fabs(value - wanted) <= 1e-9; };
  const bool finite = std::isfinite(s.translation.x) && std::isfinite(s.translation.y) &&
                      std::isfinite(s.translation.z) && std::isfinite(s.scale);
  if (!finite || !(s.scale > 0))
    throw Error(ErrorKind::usage, "a transform needs a finite translation and a scale above 0");
  if (!near(s.x_axis.length(), 1) || !near(s.y_axis.length(), 1) || !near(s.x_axis.dot(s.y_axis), 0) ||
      !((s.x_axis.cross(s.y_axis) - s.z_axis).length() <= 1e-9))
    throw Error(ErrorKind::usage, "a transform needs orthonormal, right-handed axes");
}

} // namespace levelray
