#include "levelray/convert/zero_set.hpp"

#include "levelray/mesh/prepare.hpp"
#include "support/catch.hpp"

#include <random>

using namespace levelray;

namespace {

double interpolate(const std::array<float, 8>& f, const Vec3d& p) {
  double sum = 0;
  for (std::size_t c = 0; c < 8; ++c)
    sum += (c & 1 ? p.x : 1 - p.x) * (c & 2 ? p.y : 1 - p.y) * (c & 4 ? p.z : 1 - p.z) * double{f[c]};
  return sum;
}

// An upper bound of the interpolant's second derivative along any unit direction: the sum of the mixed ones,
// each largest at one of two opposite edges.
double second_derivative(const std::array<float, 8>& f) {
  const auto d = [&](std::size_t a, std::size_t b, std::size_t at) {
    return std::fabs(double{f[at + a + b]} - double{f[at + a]} - double{f[at + b]} + double{f[at]});
  };
  return std::max(d(1, 2, 0), d(1, 2, 4)) + std::max(d(1, 4, 0), d(1, 4, 2)) +
         std::max(d(2, 4, 0), d(2, 4, 1));
}

} // namespace

TEST_CASE("triangles lie on the zero set of the interpolant, within the derived bound") {
  std::mt19937 random(2024);
  std::uniform_real_distribution<float> value(-1, 1);
  std::uniform_real_distribution<double> unit(0, 1);
  std::uint64_t triangles = 0, off_vertices = 0, off_points = 0, outside = 0;
  for (int n = 0; n < 400; ++n) {
    std::array<float, 8> f;
    for (float& v : f) v = value(random);
    const int divisions = 1 + n % max_zero_set_divisions;
    const Vec3d at(3, -5, 7);
    TriangleMesh mesh;
    append_zero_set(f, at, divisions, mesh);
    const auto [least, most] = std::minmax_element(f.begin(), f.end());
    CHECK(mesh.triangles.empty() == !(*least < 0 && *most >= 0));
    triangles += mesh.triangles.size();
    for (const Vec3d& v : mesh.vertices) {
      const Vec3d p = v - at;
      // Steps end within 1e-9 of an edge, along which values change by at most 4 (and 2 for sums of three).
      off_vertices += !(std::fabs(interpolate(f, p)) < 1e-8);
      for (int a = 0; a < 3; ++a) outside += !(p[a] >= -1e-15 && p[a] <= 1 + 1e-15);
    }
    const double bound = 3.0 / (8 * divisions * divisions) * second_derivative(f) + 1e-8;
    for (const Triangle& t : mesh.triangles) {
      double u = unit(random), v = unit(random);
      if (u + v > 1) u = 1 - u, v = 1 - v;
      const Vec3d p = mesh.vertices[t[0]] * (1 - u - v) + mesh.vertices[t[1]] * u + mesh.vertices[t[2]] * v;
      off_points += !(std::fabs(interpolate(f, p - at)) <= bound);
    }
  }
  CHECK(triangles > 10000);
  CHECK(off_vertices == 0);
  CHECK(off_points == 0);
  CHECK(outside == 0);
}

TEST_CASE("the triangles of neighbouring cells form a closed surface, noise or not") {
  constexpr int n = 7;
  std::mt19937 random(11);
  std::uniform_real_distribution<float> value(-1, 1);
  for (const int divisions : {1, 2, 3}) {
    CAPTURE(divisions);
    std::vector<float> samples(n * n * n, 1.0f); // outside along the border
    const auto at = [](int x, int y, int z) { return static_cast<std::size_t>(x + n * (y + n * z)); };
    for (int z = 1; z + 1 < n; ++z)
      for (int y = 1; y + 1 < n; ++y)
        for (int x = 1; x + 1 < n; ++x) samples[at(x, y, z)] = value(random);
    TriangleMesh mesh;
    for (int z = 0; z + 1 < n; ++z)
      for (int y = 0; y + 1 < n; ++y)
        for (int x = 0; x + 1 < n; ++x) {
          std::array<float, 8> f;
          for (int c = 0; c < 8; ++c)
            f[static_cast<std::size_t>(c)] = samples[at(x + (c & 1), y + (c >> 1 & 1), z + (c >> 2))];
          append_zero_set(f, Vec3d(x, y, z), divisions, mesh);
        }
    const MeshReport report = prepare_mesh(mesh).report; // welds by exact position
    CHECK(report.triangles > 1000);
    CHECK(report.boundary_edges == 0);
    CHECK(report.closed);
  }
}

TEST_CASE("a cell that is zero in a corner, or all over, makes no trouble") {
  TriangleMesh mesh;
  append_zero_set({0, 1, 1, 1, 1, 1, 1, 1}, Vec3d(0), 4, mesh);
  append_zero_set({0, 0, 0, 0, 0, 0, 0, 0}, Vec3d(0), 4, mesh);
  CHECK(mesh.triangles.empty()); // it does not change its sign: no surface
  append_zero_set({0, -1, -1, -1, -1, -1, -1, -1}, Vec3d(0), 2, mesh);
  CHECK(!mesh.triangles.empty());
  for (const Vec3d& v : mesh.vertices) CHECK(v.length() < 1e-8); // all in that corner
  mesh = {};
  append_zero_set({-0.0f, 3e38f, -3e38f, 1e-38f, -1e-45f, 1, -1, 3e38f}, Vec3d(0), 8, mesh);
  for (const Vec3d& v : mesh.vertices)
    CHECK((std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z)));
}
