#include "levelray/io/scene_animation.hpp"

#include "support/catch.hpp"

#include <cmath>
#include <numbers>
#include <random>

using namespace levelray;

namespace {

// Of values of order 1 after some ten operations, each exact to 1.1e-16.
constexpr double rounding = 4e-15;

Vec3d turned(const Similarity& placement, const Vec3d& p) {
  return placement.point(p);
}

TransformKey turn_key(double frame, const Vec3d& axis, double degrees) {
  TransformKey key;
  key.frame = frame;
  key.rotate = RotationFile{axis, degrees};
  return key;
}

bool near(const Vec3d& a, const Vec3d& b, double tolerance = rounding) {
  INFO(a << " " << b);
  return (a - b).length() <= tolerance;
}

} // namespace

TEST_CASE("curves pass through their keys, rest outside of them, and run straight between") {
  const std::vector<double> frames{-2, 1, 5}, values{3, -1, 7};
  for (const bool smooth : {false, true})
    for (std::size_t i = 0; i < 3; ++i) CHECK(curve_at(frames, values, frames[i], smooth) == values[i]);
  CHECK(curve_at(frames, values, -100, true) == 3);
  CHECK(curve_at(frames, values, 100, true) == 7);
  CHECK(curve_at(frames, values, -0.5, false) == 1);
  CHECK(curve_at(frames, values, 2, false) == 1);
  CHECK(curve_at({4}, {9}, 3, true) == 9);
}

TEST_CASE("smooth curves have continuous velocity, come to rest at the ends and never overshoot") {
  constexpr std::uint64_t seed = 5150;
  CAPTURE(seed);
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> step(0.5, 4), value(-1, 1);
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<double> frames{0}, values{value(random)};
    for (int i = 0; i < 6; ++i) {
      frames.push_back(frames.back() + step(random));
      values.push_back(random() % 4 == 0 ? values.back() : value(random));
    }
    const auto y = [&](double frame) { return curve_at(frames, values, frame, true); };
    for (std::size_t i = 0; i < frames.size(); ++i) {
      // One-sided differences over h of a cubic whose second derivative is below 12 * 2 / 0.5^2 = 96 (slopes
      // are at most 3 times the steepest chord): the sides differ by at most 96 h.
      const double h = 1e-6;
      CHECK(std::abs((y(frames[i] + h) - 2 * y(frames[i]) + y(frames[i] - h)) / h) < 96 * h + rounding / h);
    }
    for (std::size_t i = 0; i + 1 < frames.size(); ++i)
      for (int k = 0; k <= 20; ++k) {
        const double v = y(std::min(frames[i] + (frames[i + 1] - frames[i]) * k / 20, frames[i + 1]));
        CHECK(v >= std::min(values[i], values[i + 1]));
        CHECK(v <= std::max(values[i], values[i + 1]));
      }
  }
}

TEST_CASE("the camera's values follow the keys that name them, each on its own") {
  SceneFile scene;
  scene.film.size = {40, 30};
  scene.camera.eye = Vec3d(0, 0, 9);
  CameraKey a, b, c;
  a.frame = 1, a.eye = Vec3d(0, 0, 5);
  b.frame = 2, b.fov = 20;
  c.frame = 5, c.eye = Vec3d(4, 8, 5);
  scene.camera.keys = {a, b, c};
  CHECK(camera_at(scene, 0).eye == Vec3d(0, 0, 5));
  CHECK(camera_at(scene, 3).eye == Vec3d(2, 4, 5));
  CHECK(camera_at(scene, 3.5).eye == Vec3d(2.5, 5, 5));
  CHECK(camera_at(scene, 9).eye == Vec3d(4, 8, 5));
  for (const double frame : {-3.0, 2.0, 7.0}) {
    CHECK(camera_at(scene, frame).fov_degrees == 20);
    CHECK(camera_at(scene, frame).target == Vec3d(0, 0, 0));
    CHECK(camera_at(scene, frame).width == 40);
    CHECK(camera_at(scene, frame).height == 30);
  }
}

TEST_CASE("a camera that looks nowhere at some frame is refused with line and frame") {
  const std::string text = R"({"levelray": 1, "objects": [{"mesh": "a.obj"}],
    "camera": {"eye": [0, 0, 1], "target": [0, 0, 0],
               "keys": [{"frame": 1, "eye": [0, 0, 1]}, {"frame": 3, "eye": [0, 0, -1]}, {"frame": 4, "eye": [0, 1, 0]}]}})";
  const SceneFile scene = parse_scene(text, "shot.json");
  CHECK_NOTHROW(camera_at(scene, 1));
  CHECK_THROWS_WITH(camera_at(scene, 2), "shot.json:2: frame 2: the camera's eye and target are one point");
  CHECK_THROWS_WITH(camera_at(scene, 4),
                    "shot.json:2: frame 4: the camera's up is parallel to its view; choose another up");
}

TEST_CASE("objects are scaled, then turned, then moved") {
  TransformFile transform;
  transform.translate = Vec3d(10, 0, 0);
  transform.rotate = {Vec3d(0, 0, 5), 90};
  transform.scale = 2;
  const Similarity placement = placement_at(transform, 1);
  CHECK(near(turned(placement, Vec3d(1, 0, 0)), Vec3d(10, 2, 0)));
  CHECK(near(turned(placement, Vec3d(0, 1, 0)), Vec3d(8, 0, 0)));
}

TEST_CASE("around one axis the angle is animated, over more than one turn") {
  for (const double sign : {1.0, -1.0}) { // the same axis the other way round, with the angle's sign changed
    TransformFile transform;
    transform.keys = {turn_key(0, Vec3d(0, 1, 0), 0), turn_key(8, Vec3d(0, sign * 3, 0), sign * 720)};
    CHECK(near(turned(placement_at(transform, 1), Vec3d(0, 0, 1)), Vec3d(1, 0, 0)));
    CHECK(near(turned(placement_at(transform, 2), Vec3d(0, 0, 1)), Vec3d(0, 0, -1)));
    CHECK(turned(placement_at(transform, 4), Vec3d(0, 0, 1)) == Vec3d(0, 0, 1));
    CHECK(turned(placement_at(transform, 9), Vec3d(0, 0, 1)) == Vec3d(0, 0, 1));
    transform.interpolation = "smooth";
    CHECK(turned(placement_at(transform, 4), Vec3d(0, 0, 1)) == Vec3d(0, 0, 1)); // half way, by symmetry
  }
}

TEST_CASE("between different axes objects turn evenly along the shortest way") {
  TransformFile transform;
  transform.keys = {turn_key(0, Vec3d(1, 0, 0), 0), turn_key(6, Vec3d(0, 1, 0), 90),
                    turn_key(8, Vec3d(0, 0, 1), 350)};
  for (const std::string interpolation : {"linear", "smooth"}) {
    transform.interpolation = interpolation;
    // From no rotation to 90 degrees around y: half way, 45 degrees around y.
    const double s = std::sqrt(0.5);
    CHECK(near(turned(placement_at(transform, 3), Vec3d(0, 0, 1)), Vec3d(s, 0, s),
               interpolation == "linear" ? rounding : 0.2));
    // 350 degrees around z are 10 the other way.
    const double ten = std::numbers::pi / 18;
    CHECK(near(turned(placement_at(transform, 8), Vec3d(1, 0, 0)), Vec3d(std::cos(ten), -std::sin(ten), 0)));
  }
  transform.interpolation = "linear";
  const double third = std::numbers::pi / 6;
  CHECK(near(turned(placement_at(transform, 2), Vec3d(0, 0, 1)), Vec3d(std::sin(third), 0, std::cos(third))));
  // Every point of the arc is a rotation, and the steps are of even length: the trace of a rotation matrix is
  // 1 + 2 cos(angle).
  double first = 0;
  for (int i = 0; i < 10; ++i) {
    const Similarity a = placement_at(transform, 6 + i * 0.2), b = placement_at(transform, 6.2 + i * 0.2);
    CHECK_NOTHROW(check_similarity(a));
    const Similarity step = b * a.inverse();
    const double trace = step.x_axis.x + step.y_axis.y + step.z_axis.z;
    if (i == 0) first = trace;
    CHECK(std::abs(trace - first) < 4 * rounding);
  }
}

TEST_CASE("scale grows by equal factors") {
  TransformFile transform;
  TransformKey a, b;
  a.frame = 0, a.scale = 1;
  b.frame = 4, b.scale = 16;
  transform.keys = {a, b};
  CHECK(std::abs(placement_at(transform, 1).scale - 2) < rounding);
  CHECK(std::abs(placement_at(transform, 3).scale - 8) < 8 * rounding);
  transform.keys = {a};
  CHECK(placement_at(transform, 7).scale == 1);
}
