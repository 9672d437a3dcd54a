#include "levelray/mesh/winding_number.hpp"

#include "levelray/measure/made_meshes.hpp"
#include "support/catch.hpp"

using namespace levelray;

TEST_CASE("an octant's triangle fills an eighth of the sphere, positive from behind") {
  const Vec3d a(1, 0, 0), b(0, 1, 0), c(0, 0, 1);
  CHECK(solid_angle(a, b, c, Vec3d(0)) == Approx(std::numbers::pi / 2));
  CHECK(solid_angle(b, a, c, Vec3d(0)) == Approx(-std::numbers::pi / 2));
  CHECK(solid_angle(a, b, c, Vec3d(1)) < 0);
}

TEST_CASE("solid angles grow to half the sphere on both sides of a triangle and vanish in its plane") {
  const Vec3d a(0, 0, 0), b(4, 0, 0), c(0, 4, 0);
  const double half = 2 * std::numbers::pi;
  // From height h over the inside, what is missing of the half sphere is below h * perimeter / squared
  // distance.
  CHECK(solid_angle(a, b, c, Vec3d(1, 1, -1e-9)) == Approx(half).margin(1e-7));
  CHECK(solid_angle(a, b, c, Vec3d(1, 1, 1e-9)) == Approx(-half).margin(1e-7));
  CHECK(solid_angle(a, b, c, Vec3d(1, 1, 0)) == 0);
  CHECK(solid_angle(a, b, c, Vec3d(5, 5, 0)) == 0);
  CHECK(solid_angle(a, b, c, Vec3d(2, 0, 0)) == 0);
  CHECK(solid_angle(a, b, c, a) == 0);
  CHECK(solid_angle(a, b, a, Vec3d(1, 2, 3)) == 0);
  CHECK(solid_angle(a, b, b * 2, Vec3d(1, 2, 3)) == 0);
}

TEST_CASE("the winding number tells inside, outside, the surface, and how often") {
  CHECK(winding_number(box_mesh(), Vec3d(0.2, 0.3, 0.4)) == Approx(1).margin(1e-14));
  CHECK(winding_number(box_mesh(), Vec3d(1.2, 0.3, 0.4)) == Approx(0).margin(1e-14));
  CHECK(winding_number(box_mesh(), Vec3d(1, 0.3, 0.4)) == Approx(0.5).margin(1e-14));
  CHECK(winding_number(box_mesh(), Vec3d(1, 1, 0.4)) == Approx(0.25).margin(1e-14));
  CHECK(winding_number(box_mesh(), Vec3d(1, 1, 1)) == Approx(0.125).margin(1e-14));
  CHECK(winding_number(joined_meshes(box_mesh(), box_mesh(Vec3d(-1), Vec3d(2))), Vec3d(0.5)) ==
        Approx(2).margin(1e-14));
  CHECK(winding_number(inverted_mesh(box_mesh()), Vec3d(0.5)) == Approx(-1).margin(1e-14));
  CHECK(winding_number(without_triangles(box_mesh(), 0, 2), Vec3d(0.5)) == Approx(5.0 / 6).margin(1e-14));
}
