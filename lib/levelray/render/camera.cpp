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

// Where a framing camera looks from, and along what it has to know objects.
struct FramingView {
  CameraSettings
      settings; // target in the origin, eye at distance 1: far from the origin that would be rounded away
  std::array<Vec3d, 4> directions;
};

FramingView framing_view(int width, int height, double fov_degrees, const Vec3d& up) {
  if (!(up.length() > 0) || !is_finite(up)) throw Error(ErrorKind::usage, "camera: --up has no direction");
  FramingView result;
  CameraSettings& settings = result.settings;
  settings.width = width;
  settings.height = height;
  settings.fov_degrees = fov_degrees;
  settings.up = up.normalized();

  // Look from the front, 30 degrees to its right and 25 degrees above the horizon.
  const int axis = major_axis(settings.up);
  Vec3d front = axis == 2 ? Vec3d(0, -1, 0) : Vec3d(0, 0, 1);
  front = (front - settings.up * front.dot(settings.up)).normalized();
  const Vec3d side = settings.up.cross(front);
  const double azimuth = 30 * std::numbers::pi / 180, elevation = 25 * std::numbers::pi / 180;
  settings.target = Vec3d(0);
  settings.eye = (front * std::cos(azimuth) + side * std::sin(azimuth)) * std::cos(elevation) +
                 settings.up * std::sin(elevation);
  const Camera view(settings);

  // A point at (x, y, z) from the centre, in camera axes, is seen within the usable half angles of tangents k
  // from distance D when |x| <= k_x (D + z) and |y| <= k_y (D + z): D is the largest of four linear
  // functions.
  const double margin = 0.95;
  const double k_y = tan_half(fov_degrees) * margin, k_x = k_y * width / height;
  result.directions = {view.right() / k_x - view.forward(), -view.right() / k_x - view.forward(),
                       view.up() / k_y - view.forward(), -view.up() / k_y - view.forward()};
  return result;
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

std::array<Vec3d, 4> framing_directions(int width, int height, double fov_degrees, const Vec3d& up) {
  return framing_view(width, height, fov_degrees, up).directions;
}

CameraSettings framing_camera(const std::array<double, 4>& support, const Vec3d& centre, int width,
                              int height, double fov_degrees, const Vec3d& up) {
  const FramingView view = framing_view(width, height, fov_degrees, up);
  double distance = 0;
  for (std::size_t i = 0; i < support.size(); ++i)
    distance = std::max(distance, support[i] - centre.dot(view.directions[i]));
  // Rounding of the dot products leaves something of order 1e-16 times the coordinates for a single point.
  const double least = 1e-12 * centre.length();
  CameraSettings settings = view.settings;
  settings.target = centre;
  settings.eye = centre + view.settings.eye * (distance > least ? distance : 1);
  return settings;
}

CameraSettings framing_camera(const Box3d& bounds, int width, int height, double fov_degrees,
                              const Vec3d& up) {
  if (bounds.isEmpty()) return framing_camera(Box3d(Vec3d(0, 0, 0)), width, height, fov_degrees, up);
  std::array<double, 4> support;
  const std::array<Vec3d, 4> directions = framing_directions(width, height, fov_degrees, up);
  for (std::size_t i = 0; i < support.size(); ++i) {
    const Vec3d& d = directions[i];
    support[i] = Vec3d(d.x > 0 ? bounds.max.x : bounds.min.x, d.y > 0 ? bounds.max.y : bounds.min.y,
                       d.z > 0 ? bounds.max.z : bounds.min.z)
                     .dot(d);
  }
  return framing_camera(support, bounds.min + (bounds.max - bounds.min) * 0.5, width, height, fov_degrees,
                        up);
}

} // namespace levelray
