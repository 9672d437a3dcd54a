#include "levelray/io/polygon_triangulation.hpp"

#include "support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <random>

using namespace levelray;

namespace {

struct Cut {
  PolygonTriangulator::Result result;
  std::vector<Triangle> triangles;
};

Cut cut(const std::vector<Vec3d>& points) {
  PolygonTriangulator triangulator;
  Cut out;
  out.result = triangulator.triangulate(points, out.triangles);
  return out;
}

Vec3d area_vector(const std::vector<Vec3d>& p, const Triangle& t) {
  return (p[t[1]] - p[t[0]]).cross(p[t[2]] - p[t[0]]) * 0.5;
}

// A valid triangulation of a planar simple polygon: n - 2 triangles whose areas (not signed) sum to the
// polygon's, and whose outline is the polygon: each of its edges once, every other edge once in each
// direction.
void check_valid(const std::vector<Vec3d>& points, const Cut& c, double area, double tolerance) {
  CHECK(c.result.simple);
  REQUIRE(c.triangles.size() == points.size() - 2);
  double sum = 0;
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const Triangle& t : c.triangles) {
    sum += area_vector(points, t).length();
    for (int k = 0; k < 3; ++k) {
      ++edges[{t[k], t[(k + 1) % 3]}];
      --edges[{t[(k + 1) % 3], t[k]}];
    }
  }
  CHECK(std::abs(sum - area) <= tolerance * area);
  const std::uint32_t n = static_cast<std::uint32_t>(points.size());
  for (const auto& [edge, count] : edges) {
    const int along = (edge.first + 1) % n == edge.second ? 1 : (edge.second + 1) % n == edge.first ? -1 : 0;
    REQUIRE(count == along);
  }
}

std::vector<Vec3d> flat(const std::vector<std::array<double, 2>>& xy) {
  std::vector<Vec3d> points;
  for (const auto& p : xy) points.push_back({p[0], p[1], 0});
  return points;
}

// 2^-40: the areas of up to 1,000 triangles, each with an error of some 2^-52 of its size.
constexpr double rounding = 0x1p-40;

} // namespace

TEST_CASE("a convex polygon becomes the fan of its first corner") {
  std::vector<Vec3d> points;
  for (int i = 0; i < 12; ++i) points.push_back({std::cos(i * 0.5), std::sin(i * 0.5), 2});
  const Cut c = cut(points);
  REQUIRE(c.triangles.size() == 10);
  for (std::uint32_t i = 0; i < 10; ++i) CHECK(c.triangles[i] == Triangle{0, i + 1, i + 2});
  CHECK(c.result.deviation <= 1e-15);
}

TEST_CASE("concave polygons are covered once, in every plane and both directions") {
  const std::vector<std::array<double, 2>> comb = {{0, 0}, {7, 0}, {7, 3}, {6, 3}, {6, 1}, {5, 1},
                                                   {5, 3}, {4, 3}, {4, 1}, {3, 1}, {3, 3}, {2, 3},
                                                   {2, 1}, {1, 1}, {1, 3}, {0, 3}};
  const double area = 7 + 4 * 2;
  for (int plane = 0; plane < 3; ++plane)
    for (const bool reverse : {false, true})
      for (std::size_t start = 0; start < comb.size(); ++start) {
        std::vector<Vec3d> points(comb.size());
        for (std::size_t i = 0; i < comb.size(); ++i) {
          const auto& p = comb[(start + (reverse ? comb.size() - i : i)) % comb.size()];
          points[i][plane] = p[0];
          points[i][(plane + 1) % 3] = p[1];
          points[i][(plane + 2) % 3] = p[0] + 2 * p[1]; // tilted
        }
        check_valid(points, cut(points), area * std::sqrt(1 + 1 + 4), rounding);
      }
}

TEST_CASE("random star-shaped polygons are covered once") {
  const std::uint64_t seed = 4711;
  CAPTURE(seed);
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> radius(0.05, 1), offset(-1000, 1000);
  for (int round = 0; round < 300; ++round) {
    const int n = 4 + static_cast<int>(random() % 200);
    const Vec3d centre(offset(random), offset(random), offset(random));
    const Vec3d u(0.6, 0.8, 0), v(0, 0, 1);
    std::vector<Vec3d> points;
    for (int i = 0; i < n; ++i) {
      const double angle = 2 * M_PI * i / n, r = radius(random);
      points.push_back(centre + u * (r * std::cos(angle)) + v * (r * std::sin(angle)));
    }
    Vec3d area(0, 0, 0);
    for (int i = 1; i + 1 < n; ++i) area += (points[i] - points[0]).cross(points[i + 1] - points[0]) * 0.5;
    // Positions of 1,000 are rounded to 1e-13, next to lengths of 1 and area of at least 0.01.
    check_valid(points, cut(points), area.length(), 1e-9);
  }
}

TEST_CASE("holes joined by bridges stay open") {
  // A square with one square hole, and one with two; the bridges' corners occur twice.
  check_valid(flat({{0, 0}, {4, 0}, {4, 4}, {0, 4}, {0, 0}, {1, 1}, {1, 3}, {3, 3}, {3, 1}, {1, 1}}),
              cut(flat({{0, 0}, {4, 0}, {4, 4}, {0, 4}, {0, 0}, {1, 1}, {1, 3}, {3, 3}, {3, 1}, {1, 1}})), 12,
              rounding);
  const auto two = flat({{0, 0},
                         {1, 1},
                         {1, 2},
                         {2, 2},
                         {2, 1},
                         {1, 1},
                         {0, 0},
                         {8, 0},
                         {7, 1},
                         {6, 1},
                         {6, 2},
                         {7, 2},
                         {7, 1},
                         {8, 0},
                         {8, 4},
                         {0, 4}});
  check_valid(two, cut(two), 30, rounding);
  // Every rotation of the start.
  for (std::size_t start = 0; start < two.size(); ++start) {
    std::vector<Vec3d> turned(two);
    std::rotate(turned.begin(), turned.begin() + static_cast<std::ptrdiff_t>(start), turned.end());
    check_valid(turned, cut(turned), 30, rounding);
  }
}

TEST_CASE("corners on a straight line are kept and cost no area") {
  const auto points = flat({{0, 0}, {1, 0}, {2, 0}, {3, 0}, {3, 1}, {3, 2}, {2, 2}, {2, 1}, {1, 1}, {0, 1}});
  const Cut c = cut(points);
  check_valid(points, c, 4, rounding);
  for (const Triangle& t : c.triangles) CHECK(area_vector(points, t).z > 0);
}

TEST_CASE("a polygon that crosses itself, or has no area, still gives a triangle for each ear") {
  const Cut bow = cut(flat({{0, 0}, {2, 1}, {2, 0}, {0, 2}}));
  CHECK_FALSE(bow.result.simple);
  CHECK(bow.triangles.size() == 2);
  std::vector<Vec3d> line;
  for (int i = 0; i < 9; ++i) line.push_back({i * 1.0, i * 2.0, i * 3.0});
  CHECK(cut(line).triangles.size() == 7);
  CHECK(cut(std::vector<Vec3d>(6, Vec3d(1, 2, 3))).triangles.size() == 4);
}

TEST_CASE("extreme coordinates change nothing") {
  const auto unit = flat({{2, 0}, {0, 2}, {0.5, 0}, {0, -2}});
  const Cut plain = cut(unit);
  check_valid(unit, plain, 3, rounding);
  for (const double scale : {1e-300, 1e-160, 1e-80, 1e80, 1e160, 8e307}) {
    CAPTURE(scale);
    std::vector<Vec3d> points = unit;
    for (Vec3d& p : points) p *= scale;
    const Cut c = cut(points);
    CHECK(c.triangles == plain.triangles);
    CHECK(c.result.simple);
    CHECK(c.result.deviation == 0);
  }
}

TEST_CASE("a large concave polygon takes no time to speak of") {
  // A saw of 8,000 corners, half of them reflex.
  std::vector<Vec3d> points;
  for (int i = 0; i < 4000; ++i) points.push_back({i * 1.0, i % 2 == 0 ? 0.0 : 0.9, 0});
  for (int i = 3999; i >= 0; --i) points.push_back({i * 1.0, i % 2 == 0 ? 1.0 : 1.9, 0});
  PolygonTriangulator triangulator;
  std::vector<Triangle> triangles;
  CHECK(triangulator.triangulate(points, triangles).simple);
  CHECK(triangles.size() == points.size() - 2);
  CHECK(triangulator.work() < points.size() * points.size());
}
