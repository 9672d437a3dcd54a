#include "levelray/mesh/closest_point.hpp"

#include "levelray/measure/made_meshes.hpp"
#include "levelray/mesh/triangle_bvh.hpp"
#include "support/catch.hpp"

#include <random>

using namespace levelray;

namespace {

// The least distance over a fine net of barycentric points and what it can be off: the covering radius of the
// net.
double by_net(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& p, int n) {
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= n; ++i)
    for (int j = 0; i + j <= n; ++j) {
      const Vec3d q = (a * i + b * j + c * (n - i - j)) / n;
      least = std::min(least, (q - p).length());
    }
  return least;
}

} // namespace

TEST_CASE("the nearest point of a triangle lies on the feature that the position asks for") {
  const Vec3d a(0, 0, 0), b(4, 0, 0), c(0, 4, 0);
  const auto at = [&](double x, double y, double z) {
    return closest_point_on_triangle(a, b, c, Vec3d(x, y, z));
  };
  CHECK(at(1, 1, 2).feature == feature_face);
  CHECK(at(1, 1, 2).point == Vec3d(1, 1, 0));
  CHECK(at(1, 1, 2).distance_squared == 4);
  CHECK(at(-1, -1, 1).feature == 0);
  CHECK(at(6, -1, 1).feature == 1);
  CHECK(at(-1, 6, 1).feature == 2);
  CHECK(at(2, -1, 1).feature == feature_edge);
  CHECK(at(2, -1, 1).point == Vec3d(2, 0, 0));
  CHECK(at(3, 3, 0).feature == feature_edge + 1);
  CHECK(at(3, 3, 0).point == Vec3d(2, 2, 0));
  CHECK(at(-1, 2, 1).feature == feature_edge + 2);
  CHECK(at(4, 0, 0).feature == 1); // ties: the corner before its edges and the face
  CHECK(at(2, 0, 0).feature == feature_edge);
  CHECK(at(4, 0, 0).distance_squared == 0);
}

TEST_CASE("triangles without area or length give the distance to what is left of them") {
  const Vec3d a(0, 0, 0), b(1, 1, 1), c(3, 3, 3);
  CHECK(closest_point_on_triangle(a, b, c, Vec3d(2, 2, 2)).distance_squared == Approx(0).margin(1e-30));
  CHECK(closest_point_on_triangle(a, b, c, Vec3d(5, 3, 3)).point == c);
  CHECK(closest_point_on_triangle(c, a, b, Vec3d(0, 2, 1)).distance_squared == Approx(2));
  CHECK(closest_point_on_triangle(a, a, a, Vec3d(3, 4, 0)).distance_squared == 25);
  CHECK(closest_point_on_triangle(a, a, b, Vec3d(1, 0, 0)).distance_squared == Approx(2.0 / 3));
}

TEST_CASE("the nearest point agrees with a net of points on random triangles, slivers included") {
  std::mt19937_64 random(20);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto any = [&] { return Vec3d(uniform(random), uniform(random), uniform(random)); };
  for (int i = 0; i < 300; ++i) {
    const Vec3d a = any(), b = any(), p = any() * 1.5;
    const Vec3d c = i % 3 == 0 ? any() : a + (b - a) * uniform(random) + any() * (i % 3 == 1 ? 1e-7 : 1e-15);
    CAPTURE(i, a, b, c, p);
    const int n = 60;
    const double longest = std::max({(b - a).length(), (c - b).length(), (a - c).length()});
    const TrianglePoint q = closest_point_on_triangle(a, b, c, p);
    const double d = std::sqrt(q.distance_squared), net = by_net(a, b, c, p, n);
    CHECK(d <= net + 1e-14); // rounding of sums below 4
    CHECK(d >= net - longest / n);
    CHECK(std::abs((q.point - p).length() - d) <= 1e-14);
  }
}

TEST_CASE("the tree finds what looking at every triangle finds") {
  const TriangleMesh mesh = moved_mesh(torus_mesh(40, 20, 2, 0.5), Vec3d(1, 2, 3));
  const TriangleBvh bvh(mesh);
  std::mt19937_64 random(21);
  std::uniform_real_distribution<double> uniform(-3, 3);
  for (int i = 0; i < 300; ++i) {
    Vec3d p = Vec3d(1, 2, 3) + Vec3d(uniform(random), uniform(random), uniform(random));
    if (i % 10 == 0) p = mesh.vertices[static_cast<std::size_t>(i)]; // ties of six triangles
    const MeshPoint expected = closest_point_brute_force(mesh, p);
    const auto found = bvh.closest_point(p);
    REQUIRE(found);
    CHECK(found->distance_squared == expected.distance_squared);
    CHECK(found->triangle == expected.triangle);
    CHECK(found->feature == expected.feature);
    CHECK(found->point == expected.point);
    const double d = std::sqrt(expected.distance_squared);
    CHECK(bvh.closest_point(p, d * 1.001 + 1e-9));
    if (d > 0) CHECK_FALSE(bvh.closest_point(p, d * 0.999));
  }
  CHECK_FALSE(TriangleBvh(TriangleMesh{}).closest_point(Vec3d(0)));
}

TEST_CASE("rays through a closed mesh enter as often as they leave, also through its edges and vertices") {
  const TriangleMesh mesh = torus_mesh(40, 20, 2, 0.5);
  const TriangleBvh bvh(mesh);
  std::mt19937_64 random(22);
  std::uniform_real_distribution<double> uniform(-3, 3);
  const auto any = [&] { return Vec3d(uniform(random), uniform(random), uniform(random)); };
  int crossed = 0;
  for (int i = 0; i < 2000; ++i) {
    WorldRay ray;
    ray.origin = any() + Vec3d(0, 0, 20);
    Vec3d target = any() * 0.8;
    const Triangle& t = mesh.triangles[static_cast<std::size_t>(i) % mesh.triangles.size()];
    if (i % 4 == 1) target = (mesh.vertices[t[0]] + mesh.vertices[t[1]]) / 2;
    if (i % 4 == 2) target = mesh.vertices[t[0]];
    ray.direction = i % 4 == 3 ? Vec3d(0, 0, -1) : target - ray.origin;
    if (i % 8 == 7) ray.origin = Vec3d(mesh.vertices[t[0]].x, mesh.vertices[t[0]].y, 5);
    int balance = 0, hits = 0;
    double nearest = std::numeric_limits<double>::infinity();
    bool front = false;
    bvh.all_hits(ray, [&](const TriangleHit& hit) {
      balance += hit.front ? 1 : -1;
      ++hits;
      if (hit.t < nearest) nearest = hit.t, front = hit.front;
    });
    CAPTURE(i, ray.origin, ray.direction);
    CHECK(balance == 0);
    const auto first = bvh.first_hit(ray);
    CHECK(first.has_value() == (hits > 0));
    if (first) CHECK(first->t == nearest);
    crossed += hits > 0;
  }
  CHECK(crossed > 1000);
}

TEST_CASE("a ray meets a box where it should") {
  const TriangleMesh mesh = box_mesh();
  const TriangleBvh bvh(mesh);
  WorldRay ray;
  ray.origin = Vec3d(0.3, 0.4, -2);
  ray.direction = Vec3d(0, 0, 2);
  const auto hit = bvh.first_hit(ray);
  REQUIRE(hit);
  CHECK(hit->t == Approx(1));
  CHECK(hit->front);
  ray.t_min = 1.1;
  CHECK(bvh.first_hit(ray)->t == Approx(1.5));
  CHECK_FALSE(bvh.first_hit(ray)->front);
  ray.t_max = 1.4;
  CHECK_FALSE(bvh.first_hit(ray));
}
