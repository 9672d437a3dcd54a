#include "levelray/render/camera.hpp"

#include "levelray/core/error.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace levelray {

namespace {

bool is_finite(const Vec3d& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

// The largest component's axis.
int major_axis(const Vec3d& v) {
  const Vec3d a(std::abs(v.x), std::abs(v.y), std::abs(v.z));
  return a.x > a.y ? (a.x > a.z ? 0 : 2) : (a.y > a.z ? 1 : 2);
}

double tan_half(double fov_degrees) {
  return std::tan(fov_degrees * (std::numbers::pi / 360.0));
}

} // namespace

Camera::Camera(const CameraSettings& settings)
    : settings_(settings), half_height_(tan_half(settings.fov_degrees)) {
  const auto require = [](bool legal, const char* message) {
    if (!legal) throw Error(ErrorKind::usage, message);
  };
  require(is_finite(settings.eye) && is_finite(settings.target) && is_finite(settings.up),
          "camera: eye, target and up must be finite");
  require(settings.fov_degrees > 0 && settings.fov_degrees < 180,
          "camera: --fov must be within (0,180) degrees");
  require(settings.width >= 1 && settings.width <= 65536 && settings.height >= 1 && settings.height <= 65536,
          "camera: --size must be within 1x1 and 65536x65536 pixels");

  forward_ = settings.target - settings.eye;
  require(forward_.length() > 0, "camera: --eye and --target coincide");
  forward_.normalize();
  Vec3d up = settings.up;
  require(up.length() > 0, "camera: --up has no direction");
  up.normalize();
  right_ = forward_.cross(up);
  // A sine below 1e-6: the cross product's rounding error (1e-16) would turn the image by more than 1e-10.
  require(right_.length() > 1e-6, "camera: --up is parallel to the view; choose another --up");
  right_.normalize();
  up_ = right_.cross(forward_);
}

WorldRay Camera::ray(double x, double y) const {
  const double height = settings_.height, width = settings_.width;
  // Pixels are square: both coordinates are scaled by the image's height.
  const double u = (2 * x - width) / height * half_height_;
  const double v = (height - 2 * y) / height * half_height_;
  WorldRay ray;
  ray.origin = settings_.eye;
  ray.direction = (forward_ + right_ * u + up_ * v).normalized();
  return ray;
}

Matrix44d Camera::world_to_camera() const {
  const Vec3d &r = right_, &u = up_, &f = forward_, &e = settings_.eye;
  return Matrix44d(r.x, u.x, f.x, 0, //
                   r.y, u.y, f.y, 0, //
                   r.z, u.z, f.z, 0, //
                   -e.dot(r), -e.dot(u), -e.dot(f), 1);
}

Matrix44d Camera::world_to_ndc() const {
  // From camera space: x_ndc = 1/2 + x / (2 k a z), y_ndc = 1/2 - y / (2 k z) with k = tan(fov/2), a =
  // aspect.
  const double aspect = static_cast<double>(settings_.width) / settings_.height;
  const Matrix44d projection(1 / (2 * half_height_ * aspect), 0, 0, 0, //
                             0, -1 / (2 * half_height_), 0, 0,         //
                             0.5, 0.5, 1, 1,                           //
                             0, 0, 0, 0);
  return world_to_camera() * projection;
}

CameraSettings framing_camera(const Box3d& bounds, int width, int height, double fov_degrees,
                              const Vec3d& up) {
  if (!(up.length() > 0) || !is_finite(up)) throw Error(ErrorKind::usage, "camera: --up has no direction");
  CameraSettings settings;
  settings.width = width;
  settings.height = height;
  settings.fov_degrees = fov_degrees;
  settings.up = up.normalized();

  // Look from the front, 30 degrees to its right and 20 degrees above the horizon.
  const int axis = major_axis(settings.up);
  Vec3d front = axis == 2 ? Vec3d(0, -1, 0) : Vec3d(0, 0, 1);
  front = (front - settings.up * front.dot(settings.up)).normalized();
  const Vec3d side = settings.up.cross(front);
  const double azimuth = std::numbers::pi / 6, elevation = std::numbers::pi / 9;
  const Vec3d to_eye = (front * std::cos(azimuth) + side * std::sin(azimuth)) * std::cos(elevation) +
                       settings.up * std::sin(elevation);

  const Vec3d centre = bounds.isEmpty() ? Vec3d(0, 0, 0) : bounds.min + (bounds.max - bounds.min) * 0.5;
  settings.target = centre;
  settings.eye = centre + to_eye;
  const Camera view(settings);

  // Of each image axis, the corners (a, z) relative to the centre must satisfy |a - e| <= k (D + z), where e
  // is the eye's offset, D its distance and k the tangent of the usable half angle. With U = max(a - k z) and
  // L = min(a + k z), the smallest D is (U - L) / 2k, and e = (U + L) / 2 is feasible for it and any larger
  // D.
  const double margin = 0.95;
  const double k_vertical = tan_half(fov_degrees) * margin;
  const double k_horizontal = k_vertical * width / height;
  const auto fit = [&](const Vec3d& direction, double k, double* offset) {
    double upper = -INFINITY, lower = INFINITY;
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3d p((corner & 1 ? bounds.max : bounds.min).x, (corner & 2 ? bounds.max : bounds.min).y,
                    (corner & 4 ? bounds.max : bounds.min).z);
      const double a = (p - centre).dot(direction), z = (p - centre).dot(view.forward());
      upper = std::max(upper, a - k * z);
      lower = std::min(lower, a + k * z);
    }
    *offset = (upper + lower) / 2;
    return (upper - lower) / (2 * k);
  };
  double right_offset = 0, up_offset = 0, distance = 0;
  if (!bounds.isEmpty())
    distance =
        std::max(fit(view.right(), k_horizontal, &right_offset), fit(view.up(), k_vertical, &up_offset));
  if (!(distance > 0)) distance = 1;
  settings.target = centre + view.right() * right_offset + view.up() * up_offset;
  settings.eye = settings.target + to_eye * distance;
  return settings;
}

} // namespace levelray
