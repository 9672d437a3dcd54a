#include "levelray/io/polygon_triangulation.hpp"

#include "levelray/core/parallel.hpp"

#include <algorithm>
#include <cmath>

namespace levelray {

namespace {

// The normal with the polygon's area as length (Newell); about the first corner, so that far-away polygons
// lose nothing.
Vec3d newell_normal(const std::vector<Vec3d>& p) {
  Vec3d sum(0, 0, 0);
  for (std::size_t i = 1; i + 1 < p.size(); ++i) sum += (p[i] - p[0]).cross(p[i + 1] - p[0]);
  return sum * 0.5;
}

double plane_deviation(const std::vector<Vec3d>& p, const Vec3d& normal) {
  Vec3d centre(0, 0, 0);
  for (const Vec3d& q : p) centre += q - p[0];
  centre = p[0] + centre / static_cast<double>(p.size());
  const double length = normal.length();
  double largest = 0;
  for (const Vec3d& q : p) largest = std::max(largest, std::abs((q - centre).dot(normal)) / length);
  return largest;
}

} // namespace

// Twice the signed area of a triangle of corners: positive for a left turn.
double PolygonTriangulator::turn(std::uint32_t a, std::uint32_t b, std::uint32_t c) const noexcept {
  const Point &p = points_[a], &q = points_[b], &r = points_[c];
  return (q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x);
}

void PolygonTriangulator::mark(std::uint32_t corner) {
  may_block_[corner] = !(turn(previous_[corner], corner, next_[corner]) > 0);
}

// Whether corner p makes the triangle abc no ear. Strictly, a corner on the triangle's border blocks it too.
bool PolygonTriangulator::blocks(std::uint32_t p, std::uint32_t a, std::uint32_t b, std::uint32_t c,
                                 bool strict) const noexcept {
  const double ab = turn(a, b, p), bc = turn(b, c, p), ca = turn(c, a, p);
  if (!(ab >= 0 && bc >= 0 && ca >= 0)) return false;

  // A corner at the same place as one of the triangle's blocks it when the outline goes on into the triangle.
  const auto same = [&](std::uint32_t i) {
    return points_[i].x == points_[p].x && points_[i].y == points_[p].y;
  };
  const auto enters = [&](auto&& inside) { return inside(previous_[p]) || inside(next_[p]); };
  if (same(b)) return enters([&](std::uint32_t q) { return turn(a, b, q) > 0 && turn(b, c, q) > 0; });
  if (same(a)) return enters([&](std::uint32_t q) { return turn(a, b, q) > 0 && turn(c, a, q) > 0; });
  if (same(c)) return enters([&](std::uint32_t q) { return turn(b, c, q) > 0 && turn(c, a, q) > 0; });
  return strict || (ab > 0 && bc > 0 && ca > 0);
}

bool PolygonTriangulator::is_ear(std::uint32_t b, bool strict) {
  const std::uint32_t a = previous_[b], c = next_[b];
  const double area = turn(a, b, c);
  ++work_;
  if (strict ? !(area > 0) : !(area >= 0)) return false;

  const double low_x = std::min({points_[a].x, points_[b].x, points_[c].x});
  const double high_x = std::max({points_[a].x, points_[b].x, points_[c].x});
  const double low_y = std::min({points_[a].y, points_[b].y, points_[c].y});
  const double high_y = std::max({points_[a].y, points_[b].y, points_[c].y});
  std::size_t kept = 0;
  bool blocked = false;
  for (std::size_t i = 0; i < reflex_.size(); ++i) {
    const std::uint32_t p = reflex_[i];
    if (!may_block_[p]) continue; // clipped, or convex by now: leaves the list
    reflex_[kept++] = p;
    ++work_;
    if (blocked || p == a || p == b || p == c) continue;
    const Point& q = points_[p];
    if (q.x < low_x || q.x > high_x || q.y < low_y || q.y > high_y) continue;
    if (blocks(p, a, b, c, strict)) {
      // Keep the rest of the list as it is.
      blocked = true;
      if (kept == i + 1) return false;
      reflex_.erase(reflex_.begin() + static_cast<std::ptrdiff_t>(kept),
                    reflex_.begin() + static_cast<std::ptrdiff_t>(i + 1));
      return false;
    }
  }
  reflex_.resize(kept);
  return true;
}

// Appends the triangles of the outline; false when one is turned the wrong way.
bool PolygonTriangulator::clip_ears(std::vector<Triangle>& triangles) {
  std::size_t left = points_.size();
  std::uint32_t b = 1;
  std::size_t misses = 0;
  bool strict = true;
  std::uint64_t next_look = work_ + (1 << 20);
  while (left > 3) {
    if (work_ > next_look) {
      check_cancel();
      if (work_ > max_work) break;
      next_look = work_ + (1 << 20);
    }
    if (!is_ear(b, strict)) {
      b = next_[b];
      if (++misses < left) continue;
      // A whole round without an ear: allow ears without area, then give up.
      if (!strict) break;
      strict = false;
      misses = 0;
      continue;
    }
    const std::uint32_t a = previous_[b], c = next_[b];
    triangles.push_back({a, b, c});
    next_[a] = c;
    previous_[c] = a;
    may_block_[b] = 0;
    // The neighbours' turns change; only a convex corner can newly become one that blocks (by rounding or
    // in an outline that crosses itself).
    for (const std::uint32_t corner : {a, c}) {
      const bool before = may_block_[corner] != 0;
      mark(corner);
      if (!before && may_block_[corner] != 0) reflex_.push_back(corner);
    }
    --left;
    misses = 0;
    strict = true;
    b = c;
  }
  // The last triangle, or the fan of an outline without ears.
  bool simple = true;
  const std::uint32_t a = previous_[b];
  for (; left > 2; --left) {
    const std::uint32_t c = next_[b];
    triangles.push_back({a, b, c});
    if (turn(a, b, c) < 0) simple = false;
    b = c;
  }
  return simple;
}

PolygonTriangulator::Result PolygonTriangulator::triangulate(const std::vector<Vec3d>& corners,
                                                             std::vector<Triangle>& triangles) {
  triangles.clear();
  const std::uint32_t n = static_cast<std::uint32_t>(corners.size());

  // Bring extreme coordinates to where products of three of them neither overflow nor vanish.
  double largest = 0;
  for (const Vec3d& p : corners) largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  double scale = 1;
  if (largest > 0 && !(largest > 1e-90 && largest < 1e90)) {
    int exponent = 0;
    std::frexp(largest, &exponent);
    const int shift = std::clamp(-exponent, -1020, 1020);
    scale = std::ldexp(1.0, shift);
    scaled_ = corners;
    for (Vec3d& p : scaled_) p *= scale;
  }
  const std::vector<Vec3d>& p = scale == 1 ? corners : scaled_;

  const Vec3d normal = newell_normal(p);
  const double size = std::max({std::abs(normal.x), std::abs(normal.y), std::abs(normal.z)});
  if (!(size > 0)) { // no area at all: any triangles do
    for (std::uint32_t i = 1; i + 1 < n; ++i) triangles.push_back({0, i, i + 1});
    return {};
  }
  Result result;
  result.deviation = plane_deviation(p, normal) / scale;

  // Look along the axis of the largest component, so that the polygon turns left.
  const int axis = std::abs(normal.x) == size ? 0 : std::abs(normal.y) == size ? 1 : 2;
  int u = (axis + 1) % 3, v = (axis + 2) % 3;
  if (normal[axis] < 0) std::swap(u, v);
  points_.resize(n);
  previous_.resize(n);
  next_.resize(n);
  for (std::uint32_t i = 0; i < n; ++i) {
    points_[i] = {p[i][u], p[i][v]};
    previous_[i] = i == 0 ? n - 1 : i - 1;
    next_[i] = i + 1 == n ? 0 : i + 1;
  }
  may_block_.assign(n, 0);
  reflex_.clear();
  for (std::uint32_t i = 0; i < n; ++i) {
    mark(i);
    if (may_block_[i]) reflex_.push_back(i);
  }
  result.simple = clip_ears(triangles);
  return result;
}

} // namespace levelray
