#include "levelray/io/scene_animation.hpp"

#include "levelray/core/error.hpp"

#include <ImathMatrix.h>
#include <ImathQuat.h>
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

namespace levelray {

namespace {

using Quat = Imath::Quatd;

// The slope at the inner point i: a harmonic mean of those beside it, 0 where the curve turns.
double inner_slope(const std::vector<double>& x, const std::vector<double>& y, std::size_t i) {
  const double h0 = x[i] - x[i - 1], h1 = x[i + 1] - x[i];
  const double d0 = (y[i] - y[i - 1]) / h0, d1 = (y[i + 1] - y[i]) / h1;
  if (!((d0 > 0 && d1 > 0) || (d0 < 0 && d1 < 0))) return 0;
  const double w0 = 2 * h1 + h0, w1 = h1 + 2 * h0;
  return (w0 + w1) / (w0 / d0 + w1 / d1);
}

// The interval's number i, with frame in [frames[i], frames[i + 1]] and its fraction u; false at rest.
bool interval_of(const std::vector<double>& frames, double frame, std::size_t* i, double* u) {
  if (!(frame > frames.front()) || !(frame < frames.back())) return false;
  *i = static_cast<std::size_t>(std::upper_bound(frames.begin(), frames.end(), frame) - frames.begin()) - 1;
  *u = (frame - frames[*i]) / (frames[*i + 1] - frames[*i]);
  return true;
}

// The keys that name a value, with their frames.
template <class Value>
struct Track {
  std::vector<double> frames;
  std::vector<Value> values;
};

template <class Key, class Value>
Track<Value> track_of(const std::vector<Key>& keys, std::optional<Value> Key::*member) {
  Track<Value> track;
  for (const Key& key : keys)
    if (key.*member) {
      track.frames.push_back(key.frame);
      track.values.push_back(*(key.*member));
    }
  return track;
}

double at(const Track<double>& track, double base, double frame, bool smooth) {
  return track.frames.empty() ? base : curve_at(track.frames, track.values, frame, smooth);
}

Vec3d at(const Track<Vec3d>& track, const Vec3d& base, double frame, bool smooth) {
  if (track.frames.empty()) return base;
  Vec3d result;
  for (int c = 0; c < 3; ++c) {
    std::vector<double> values;
    for (const Vec3d& value : track.values) values.push_back(value[c]);
    result[c] = curve_at(track.frames, values, frame, smooth);
  }
  return result;
}

Quat rotation_of(const Vec3d& unit_axis, double degrees) {
  // Whole turns are taken off first, which is exact, so that 360 degrees are none to the last bit.
  const double half = std::remainder(degrees, 360) * (std::numbers::pi / 360);
  return Quat(std::cos(half), unit_axis * std::sin(half));
}

// Shoemake's great arc; nearly equal quaternions are joined straight, where the arc's sines cancel: below an
// angle of 1e-4, chord and arc differ by less than 1e-9 of it.
Quat arc(const Quat& a, const Quat& b, double u) {
  const double angle = std::acos(std::clamp(a ^ b, -1.0, 1.0));
  if (!(angle > 1e-4)) return (a * (1 - u) + b * u).normalized();
  return (a * (std::sin((1 - u) * angle) / std::sin(angle)) + b * (std::sin(u * angle) / std::sin(angle)))
      .normalized();
}

Quat at(const Track<RotationFile>& track, const RotationFile& base, double frame, bool smooth) {
  if (track.frames.empty()) return rotation_of(base.axis.normalized(), base.degrees);
  // One axis, to a few units in the last place: only the angle changes.
  const Vec3d axis = track.values.front().axis.normalized();
  Track<double> angles{track.frames, {}};
  for (const RotationFile& key : track.values)
    if (const double cosine = axis.dot(key.axis.normalized()); std::abs(cosine) > 1 - 1e-14)
      angles.values.push_back(std::copysign(1.0, cosine) * key.degrees);
  if (angles.values.size() == track.values.size()) return rotation_of(axis, at(angles, 0, frame, smooth));

  // A quaternion and its negative are the same rotation: take those that are nearest to their predecessors.
  std::vector<Quat> turns;
  for (const RotationFile& key : track.values) {
    const Quat turn = rotation_of(key.axis.normalized(), key.degrees);
    turns.push_back(!turns.empty() && (turns.back() ^ turn) < 0 ? -turn : turn);
  }
  std::size_t i = 0;
  double u = 0;
  if (!smooth && interval_of(track.frames, frame, &i, &u)) return arc(turns[i], turns[i + 1], u);
  Quat result;
  for (int c = 0; c < 4; ++c) {
    std::vector<double> values;
    for (const Quat& turn : turns) values.push_back(turn[c]);
    result[c] = curve_at(track.frames, values, frame, smooth);
  }
  return result.normalized();
}

} // namespace

double curve_at(const std::vector<double>& frames, const std::vector<double>& values, double frame,
                bool smooth) {
  std::size_t i = 0;
  double u = 0;
  if (!interval_of(frames, frame, &i, &u)) return frame > frames.front() ? values.back() : values.front();
  const double y0 = values[i], y1 = values[i + 1];
  if (!smooth) return y0 * (1 - u) + y1 * u;
  const double h = frames[i + 1] - frames[i];
  const double m0 = i == 0 ? 0 : inner_slope(frames, values, i) * h;
  const double m1 = i + 2 == frames.size() ? 0 : inner_slope(frames, values, i + 1) * h;
  // Hermite's cubic.
  const double d = y1 - y0;
  const double y = y0 + u * (m0 + u * (3 * d - 2 * m0 - m1 + u * (m0 + m1 - 2 * d)));
  return std::clamp(y, std::min(y0, y1), std::max(y0, y1)); // rounding only
}

CameraSettings camera_at(const SceneFile& scene, double frame) {
  const CameraFile& camera = scene.camera;
  const bool smooth = camera.interpolation == "smooth";
  CameraSettings settings;
  settings.eye = at(track_of(camera.keys, &CameraKey::eye), camera.eye, frame, smooth);
  settings.target = at(track_of(camera.keys, &CameraKey::target), camera.target, frame, smooth);
  settings.up = at(track_of(camera.keys, &CameraKey::up), camera.up, frame, smooth);
  settings.fov_degrees = at(track_of(camera.keys, &CameraKey::fov), camera.fov, frame, smooth);
  settings.width = scene.film.size[0];
  settings.height = scene.film.size[1];
  const auto require = [&](bool good, const char* reason) {
    if (!good) throw Error(ErrorKind::usage, fmt::format("{}: frame {}: {}", camera.place, frame, reason));
  };
  require((settings.target - settings.eye).length() > 0, "the camera's eye and target are one point");
  require(settings.up.length() > 0, "the camera's up has no direction");
  // As Camera has it.
  require((settings.target - settings.eye).normalized().cross(settings.up.normalized()).length() > 1e-6,
          "the camera's up is parallel to its view; choose another up");
  return settings;
}

Similarity placement_at(const TransformFile& transform, double frame) {
  const bool smooth = transform.interpolation == "smooth";
  Similarity placement;
  placement.translation =
      at(track_of(transform.keys, &TransformKey::translate), transform.translate, frame, smooth);
  // Imath's vectors are rows: a matrix's rows are the images of the axes.
  const Imath::M33d axes =
      at(track_of(transform.keys, &TransformKey::rotate), transform.rotate, frame, smooth).toMatrix33();
  placement.x_axis = Vec3d(axes[0][0], axes[0][1], axes[0][2]);
  placement.y_axis = Vec3d(axes[1][0], axes[1][1], axes[1][2]);
  placement.z_axis = Vec3d(axes[2][0], axes[2][1], axes[2][2]);
  Track<double> scales = track_of(transform.keys, &TransformKey::scale);
  const bool animated = std::adjacent_find(scales.values.begin(), scales.values.end(),
                                           std::not_equal_to<>()) != scales.values.end();
  if (!animated) { // without a detour over the logarithm
    placement.scale = scales.values.empty() ? transform.scale : scales.values.front();
  } else {
    for (double& scale : scales.values) scale = std::log(scale);
    placement.scale = std::exp(at(scales, 0, frame, smooth));
  }
  return placement;
}

} // namespace levelray
