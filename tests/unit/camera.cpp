#include "levelray/render/camera.hpp"

#include "levelray/core/error.hpp"
#include "support/catch.hpp"

#include <cmath>
#include <random>

using namespace levelray;

namespace {

// Where a world point falls in the image, in pixels, by the matrix that EXR files carry.
Vec3d project(const Matrix44d& world_to_ndc, const CameraSettings& s, const Vec3d& point) {
  Vec3d ndc;
  world_to_ndc.multVecMatrix(point, ndc); // divides by w
  return Vec3d(ndc.x * s.width, ndc.y * s.height, 0);
}

CameraSettings random_camera(std::mt19937& random) {
  std::uniform_real_distribution<double> unit(-1, 1);
  CameraSettings s;
  s.eye = Vec3d(unit(random), unit(random), unit(random)) * 10.0;
  s.target = Vec3d(unit(random), unit(random), unit(random));
  s.up = Vec3d(unit(random), unit(random), unit(random));
  s.fov_degrees = 10 + 50 * (unit(random) + 1);
  s.width = 37 + static_cast<int>(random() % 600);
  s.height = 11 + static_cast<int>(random() % 600);
  return s;
}

} // namespace

TEST_CASE("points on a pixel's ray project back to the pixel through worldToNDC") {
  const unsigned seed = 20;
  INFO("seed " << seed);
  std::mt19937 random(seed);
  for (int i = 0; i < 200; ++i) {
    const CameraSettings s = random_camera(random);
    const Camera camera(s);
    const double x = static_cast<int>(random() % static_cast<unsigned>(s.width)) + 0.5;
    const double y = static_cast<int>(random() % static_cast<unsigned>(s.height)) + 0.5;
    const WorldRay ray = camera.ray(x, y);
    CHECK(ray.direction.length() == Approx(1).epsilon(1e-15));
    const Vec3d p = project(camera.world_to_ndc(), s, ray.at(3.0));
    // In double: rounding of a few 1e-16 times the image's size of some 600 pixels, amplified by the distance
    // of up to 20 units over 3.
    CHECK(std::hypot(p.x - x, p.y - y) < 1e-9);
    // As stored in the file, with 24 bits a matrix element: 600 pixels * 20/3 * a few 2^-24 is below 0.002.
    const Imath::M44f stored(camera.world_to_ndc());
    const Vec3d q = project(Matrix44d(stored), s, ray.at(3.0));
    CHECK(std::hypot(q.x - x, q.y - y) < 0.01);
  }
}

TEST_CASE("pixel (0,0) is the top left one, and camera space has x right, y up, z along the view") {
  CameraSettings s;
  s.width = 300;
  s.height = 200;
  const Camera camera(s); // at z = 5, looking along -z
  CHECK(camera.ray(0.5, 0.5).direction.x < 0);
  CHECK(camera.ray(0.5, 0.5).direction.y > 0);
  Vec3d p;
  camera.world_to_camera().multVecMatrix(Vec3d(1, 2, 0), p);
  CHECK((p - Vec3d(1, 2, 5)).length() < 1e-15);
  // The field of view is vertical: the middle of the top edge is fov/2 above the axis.
  const Vec3d top = camera.ray(150, 0).direction;
  CHECK(std::atan2(top.y, -top.z) * 180 / M_PI == Approx(22.5).epsilon(1e-14));
}

TEST_CASE("a camera without a view is refused with a reason") {
  const auto refuses = [](auto change) {
    CameraSettings s;
    change(s);
    try {
      const Camera camera(s);
      return false;
    } catch (const Error& error) {
      return error.kind() == ErrorKind::usage;
    }
  };
  CHECK(refuses([](CameraSettings& s) { s.target = s.eye; }));
  CHECK(refuses([](CameraSettings& s) { s.up = Vec3d(0, 0, 1); }));
  CHECK(refuses([](CameraSettings& s) { s.up = Vec3d(0, 0, 0); }));
  CHECK(refuses([](CameraSettings& s) { s.fov_degrees = 180; }));
  CHECK(refuses([](CameraSettings& s) { s.fov_degrees = NAN; }));
  CHECK(refuses([](CameraSettings& s) { s.eye.y = NAN; }));
  CHECK(refuses([](CameraSettings& s) { s.width = 0; }));
}

TEST_CASE("the framing camera sees the whole box, large and upright") {
  const unsigned seed = 7;
  INFO("seed " << seed);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> exponent(-6, 6), unit(-1, 1);
  for (int i = 0; i < 300; ++i) {
    const double scale = std::pow(10, exponent(random));
    const Vec3d low = Vec3d(unit(random), unit(random), unit(random)) * scale * 3.0;
    const Vec3d size = Vec3d(1 + unit(random), 1 + unit(random), 1 + unit(random)) * scale;
    const Box3d box(low, low + size);
    const int width = 50 + static_cast<int>(random() % 500), height = 50 + static_cast<int>(random() % 500);
    Vec3d up(0, 0, 0);
    up[static_cast<int>(random() % 3)] = random() % 2 ? 1 : -1;
    const CameraSettings s = framing_camera(box, width, height, 20 + 40 * (unit(random) + 1), up);
    const Camera camera(s);
    Box3d seen;
    for (int c = 0; c < 8; ++c) {
      const Vec3d p(c & 1 ? box.max.x : low.x, c & 2 ? box.max.y : low.y, c & 4 ? box.max.z : low.z);
      CHECK((p - s.eye).dot(camera.forward()) > 0);
      const Vec3d q = project(camera.world_to_ndc(), s, p);
      seen.extendBy(Vec3d(q.x / width, q.y / height, 0));
    }
    // The corner that is farthest out reaches 95% of the image's half: 0.025 of the image is left.
    const double left = std::min({seen.min.x, seen.min.y, 1 - seen.max.x, 1 - seen.max.y});
    CHECK(left == Approx(0.025).epsilon(1e-6));
    CHECK(camera.up().dot(up) > 0.9); // cos(25 degrees) = 0.906
  }
}

TEST_CASE("boxes without extent are framed too") {
  const CameraSettings point = framing_camera(Box3d(Vec3d(1, 2, 3)), 64, 64);
  CHECK((point.eye - Vec3d(1, 2, 3)).length() == Approx(1));
  CHECK_NOTHROW(Camera(framing_camera(Box3d(), 64, 64)));
  CHECK_THROWS_AS(framing_camera(Box3d(), 64, 64, 45, Vec3d(0, 0, 0)), Error);
}
