#include "levelray/render/similarity.hpp"

#include "levelray/core/error.hpp"
#include "support/catch.hpp"

#include <bit>
#include <cmath>
#include <limits>
#include <random>

using namespace levelray;

namespace {

double distance(const Vec3d& a, const Vec3d& b) {
  return (a - b).length();
}

Similarity random_similarity(std::mt19937& random) {
  std::uniform_real_distribution<double> unit(-1, 1);
  return Similarity::translated(Vec3d(unit(random), unit(random), unit(random)) * 3.0) *
         Similarity::rotated(Vec3d(unit(random), unit(random), 1.5 + unit(random)), 400 * unit(random)) *
         Similarity::scaled(std::exp(unit(random)));
}

std::uint64_t bits(double x) {
  return std::bit_cast<std::uint64_t>(x);
}

} // namespace

TEST_CASE("a similarity scales first, then rotates counter-clockwise, then translates") {
  const Similarity s = Similarity::translated(Vec3d(10, 20, 30)) * Similarity::rotated(Vec3d(0, 0, 5), 90) *
                       Similarity::scaled(2);
  CHECK(s.point(Vec3d(1, 0, 0)) == Vec3d(10, 22, 30)); // quarter turns are exact
  CHECK(s.point(Vec3d(0, 1, 0)) == Vec3d(8, 20, 30));
  CHECK(s.vector(Vec3d(0, 0, 1)) == Vec3d(0, 0, 2));
  CHECK(s.rotate(Vec3d(1, 0, 0)) == Vec3d(0, 1, 0));
  CHECK(distance(Similarity::rotated(Vec3d(1, 1, 1), 120).point(Vec3d(1, 2, 3)), Vec3d(3, 1, 2)) < 1e-15);
  CHECK(Similarity::rotated(Vec3d(0, 1, 0), -270).rotate(Vec3d(0, 0, 1)) == Vec3d(1, 0, 0));
}

TEST_CASE("similarities compose, invert, and keep t, angles and ratios of lengths") {
  const unsigned seed = 4;
  CAPTURE(seed);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int i = 0; i < 1000; ++i) {
    const Similarity a = random_similarity(random), b = random_similarity(random);
    const Vec3d p(unit(random), unit(random), unit(random)), q(unit(random), unit(random), unit(random));
    // Some 20 roundings of numbers up to 3 e + 3 (3 e + 3) < 45: 20 * 45 * 2^-53.
    const double bound = 1e-13;
    REQUIRE(distance((a * b).point(p), a.point(b.point(p))) < bound);
    REQUIRE(distance(a.inverse().point(a.point(p)), p) < bound);
    REQUIRE(std::fabs(distance(a.point(p), a.point(q)) - a.scale * distance(p, q)) < bound);
    REQUIRE(std::fabs(a.rotate(p).cross(a.rotate(q)).dot(a.rotate(p.cross(q))) - p.cross(q).dot(p.cross(q))) <
            bound); // and the sense of rotation
    WorldRay ray;
    ray.origin = p, ray.direction = q, ray.t_min = 0.25, ray.t_max = 7;
    const WorldRay moved = a.ray(ray);
    REQUIRE(distance(moved.at(2.5), a.point(ray.at(2.5))) < bound);
    REQUIRE((moved.t_min == 0.25 && moved.t_max == 7));
    REQUIRE_NOTHROW(check_similarity(a * b));
    REQUIRE(a.box(Box3d(p, p)).min == a.point(p));
  }
}

TEST_CASE("the identity passes rays through bit by bit, signs of zeros included") {
  WorldRay ray;
  ray.origin = Vec3d(-0.0, 1e300, 5e-324);
  ray.direction = Vec3d(-0.0, 0.1, -1e-310);
  const Similarity none = Similarity::rotated(Vec3d(1, 2, 3), 360) * Similarity::scaled(1);
  REQUIRE(none.is_identity());
  const WorldRay same = none.ray(ray);
  for (int a = 0; a < 3; ++a) {
    CHECK(bits(same.origin[a]) == bits(ray.origin[a]));
    CHECK(bits(same.direction[a]) == bits(ray.direction[a]));
  }
  CHECK_FALSE(Similarity::translated(Vec3d(0, 1e-300, 0)).is_identity());
  CHECK(Similarity().box(Box3d()).isEmpty());
}

TEST_CASE("what is no similarity is refused") {
  const auto refuses = [](auto change) {
    Similarity s;
    change(s);
    try {
      check_similarity(s);
      return false;
    } catch (const Error& error) {
      return error.kind() == ErrorKind::usage;
    }
  };
  CHECK(refuses([](Similarity& s) { s.scale = 0; }));
  CHECK(refuses([](Similarity& s) { s.scale = -1; }));
  CHECK(refuses([](Similarity& s) { s.scale = std::numeric_limits<double>::infinity(); }));
  CHECK(refuses([](Similarity& s) { s.translation.y = NAN; }));
  CHECK(refuses([](Similarity& s) { s.x_axis = Vec3d(1, 1e-6, 0); }));
  CHECK(refuses([](Similarity& s) { s.z_axis = Vec3d(0, 0, -1); })); // a mirror image
  CHECK(refuses([](Similarity& s) { s.y_axis = Vec3d(NAN, 1, 0); }));
  CHECK_THROWS_AS(Similarity::rotated(Vec3d(0, 0, 0), 10), Error);
  CHECK_THROWS_AS(Similarity::rotated(Vec3d(0, 1, 0), NAN), Error);
}
