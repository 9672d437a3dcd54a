#include "levelray/mesh/triangle_bvh.hpp"

#include "levelray/core/parallel.hpp"

#include <algorithm>
#include <cmath>

namespace levelray {

namespace {

constexpr std::uint32_t leaf_size = 4;
constexpr double ulp = std::numeric_limits<double>::epsilon();

// Squared distance from p to the box, 0 inside; never above the true one by more than 4 ulp.
double distance_squared(const Vec3d& min, const Vec3d& max, const Vec3d& p) {
  double sum = 0;
  for (int i = 0; i < 3; ++i) {
    const double d = std::max({min[i] - p[i], p[i] - max[i], 0.0});
    sum += d * d;
  }
  return sum;
}

// Whether the ray meets the box in [t_min, limit]. Parameters of the slabs carry three roundings each (Ize
// 2013, section 3: 1 + 2 gamma(3) on the far ones makes the test conservative).
bool meets(const WorldRay& ray, const Vec3d& min, const Vec3d& max, double limit) {
  double near = ray.t_min, far = limit;
  for (int i = 0; i < 3; ++i) {
    const double o = ray.origin[i], d = ray.direction[i];
    if (d == 0) {
      if (o < min[i] || o > max[i]) return false;
      continue;
    }
    double t0 = (min[i] - o) / d, t1 = (max[i] - o) / d;
    if (t0 > t1) std::swap(t0, t1);
    near = std::max(near, t0 - 4 * ulp * std::abs(t0));
    far = std::min(far, t1 + 4 * ulp * std::abs(t1));
  }
  return near <= far;
}

// The plane across a ray, in which the ray is the origin (Woop, Benthin & Wald 2013, section 2: shear, no
// rotation). Each vertex is rounded once, for all of its triangles; what follows is exact, unlike in the
// paper, where ties are recomputed in double precision.
class RayPlane {
 public:
  struct Point {
    double x, y, t; // t: parameter on the ray
  };

  explicit RayPlane(const WorldRay& ray) : origin_(ray.origin) {
    for (int i = 0; i < 3; ++i)
      if (std::abs(ray.direction[i]) > std::abs(ray.direction[z_])) z_ = i;
    x_ = (z_ + 1) % 3, y_ = (z_ + 2) % 3;
    if (ray.direction[z_] < 0) std::swap(x_, y_);
    shear_x_ = ray.direction[x_] / ray.direction[z_];
    shear_y_ = ray.direction[y_] / ray.direction[z_];
    scale_ = ray.direction[z_];
  }

  Point operator()(const Vec3d& v) const {
    const Vec3d r = v - origin_;
    return {r[x_] - shear_x_ * r[z_], r[y_] - shear_y_ * r[z_], r[z_] / scale_};
  }

 private:
  Vec3d origin_;
  int x_ = 0, y_ = 1, z_ = 0;
  double shear_x_ = 0, shear_y_ = 0, scale_ = 1;
};

// The side, 1 or -1, on which the line through u and v has the origin; 0 if u == v. Exact: rounding is
// monotone, so different products compare right, and the errors of equal ones are numbers themselves. An
// origin on the line counts as moved by (e, e^2) with an infinitesimal e, for all edges alike.
int side(const RayPlane::Point& u, const RayPlane::Point& v) {
  const double p = u.x * v.y, q = u.y * v.x;
  if (p != q) return p > q ? 1 : -1;
  const double p_error = std::fma(u.x, v.y, -p), q_error = std::fma(u.y, v.x, -q);
  if (p_error != q_error) return p_error > q_error ? 1 : -1;
  if (u.y != v.y) return u.y > v.y ? 1 : -1;
  return u.x == v.x ? 0 : v.x > u.x ? 1 : -1;
}

std::optional<TriangleHit> hit_triangle(const TriangleMesh& mesh, const WorldRay& ray, const RayPlane& plane,
                                        std::uint32_t triangle) {
  const Triangle& corners = mesh.triangles[triangle];
  const RayPlane::Point a = plane(mesh.vertices[corners[0]]), b = plane(mesh.vertices[corners[1]]),
                        c = plane(mesh.vertices[corners[2]]);
  const int s = side(a, b);
  if (s == 0 || side(b, c) != s || side(c, a) != s) return std::nullopt;
  // Interpolate between the corners; weights that round to nothing mean that any of them will do.
  const double wa = std::abs(b.x * c.y - b.y * c.x), wb = std::abs(c.x * a.y - c.y * a.x),
               wc = std::abs(a.x * b.y - a.y * b.x);
  const double sum = wa + wb + wc;
  const double t = sum > 0 ? (wa * a.t + wb * b.t + wc * c.t) / sum : a.t;
  if (!(t >= ray.t_min && t <= ray.t_max)) return std::nullopt;
  return TriangleHit{t, triangle, s < 0};
}

} // namespace

TriangleBvh::TriangleBvh(const TriangleMesh& mesh) : mesh_(mesh), order_(mesh.triangles.size()) {
  std::vector<Vec3d> centre(order_.size());
  for (std::uint32_t t = 0; t < order_.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    order_[t] = t;
    centre[t] = (mesh.vertices[a] + mesh.vertices[b] + mesh.vertices[c]) / 3;
  }
  if (order_.empty()) return;
  struct Work {
    std::uint32_t node, begin, end;
  };
  std::vector<Work> stack{{0, 0, static_cast<std::uint32_t>(order_.size())}};
  nodes_.resize(1);
  while (!stack.empty()) {
    const Work work = stack.back();
    stack.pop_back();
    if (work.end - work.begin > 100000) check_cancel();
    Box3d box, centres;
    for (std::uint32_t i = work.begin; i < work.end; ++i) {
      for (const std::uint32_t v : mesh.triangles[order_[i]]) box.extendBy(mesh.vertices[v]);
      centres.extendBy(centre[order_[i]]);
    }
    // Widen by what closest_point_on_triangle may be off for triangles of this size, so that no box rules out
    // a point that brute force would have found.
    const double slack = 16 * ulp * box.size().length();
    nodes_[work.node].min = box.min - Vec3d(slack);
    nodes_[work.node].max = box.max + Vec3d(slack);
    if (work.end - work.begin <= leaf_size) {
      nodes_[work.node].first = work.begin;
      nodes_[work.node].count = work.end - work.begin;
      continue;
    }
    const int axis = static_cast<int>(centres.majorAxis());
    const std::uint32_t middle = work.begin + (work.end - work.begin) / 2;
    std::nth_element(order_.begin() + work.begin, order_.begin() + middle, order_.begin() + work.end,
                     [&](std::uint32_t s, std::uint32_t t) {
                       const double x = centre[s][axis], y = centre[t][axis];
                       return x != y ? x < y : s < t;
                     });
    const auto left = static_cast<std::uint32_t>(nodes_.size());
    nodes_[work.node].first = left;
    nodes_.resize(nodes_.size() + 2);
    stack.push_back({left + 1, middle, work.end});
    stack.push_back({left, work.begin, middle});
  }
}

std::optional<MeshPoint> TriangleBvh::closest_point(const Vec3d& p, double radius) const {
  if (nodes_.empty()) return std::nullopt;
  MeshPoint best;
  best.distance_squared = radius * radius;
  bool found = false;
  std::vector<std::pair<double, std::uint32_t>> stack{{0, 0}};
  while (!stack.empty()) {
    const auto [bound, index] = stack.back();
    stack.pop_back();
    if (bound * (1 - 16 * ulp) > best.distance_squared) continue; // ties are looked at
    const Node& node = nodes_[index];
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
      const std::uint32_t t = order_[i];
      const auto& [a, b, c] = mesh_.triangles[t];
      const TrianglePoint q =
          closest_point_on_triangle(mesh_.vertices[a], mesh_.vertices[b], mesh_.vertices[c], p);
      const bool nearer = q.distance_squared < best.distance_squared;
      const bool ties = q.distance_squared == best.distance_squared && (!found || t < best.triangle);
      if (!nearer && !ties) continue;
      static_cast<TrianglePoint&>(best) = q;
      best.triangle = t;
      found = true;
    }
    if (node.count > 0) continue;
    std::pair<double, std::uint32_t> left{0, node.first}, right{0, node.first + 1};
    left.first = distance_squared(nodes_[left.second].min, nodes_[left.second].max, p);
    right.first = distance_squared(nodes_[right.second].min, nodes_[right.second].max, p);
    if (right.first < left.first) std::swap(left, right);
    stack.push_back(right);
    stack.push_back(left); // the nearer one is looked at first
  }
  if (!found) return std::nullopt;
  return best;
}

template <class Limit, class Visit>
void TriangleBvh::walk(const WorldRay& ray, Limit&& limit, Visit&& visit) const {
  if (nodes_.empty()) return;
  std::vector<std::uint32_t> stack{0};
  while (!stack.empty()) {
    const Node& node = nodes_[stack.back()];
    stack.pop_back();
    if (!meets(ray, node.min, node.max, limit())) continue;
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) visit(order_[i]);
    if (node.count == 0) stack.insert(stack.end(), {node.first + 1, node.first});
  }
}

void TriangleBvh::all_hits(const WorldRay& ray, const std::function<void(const TriangleHit&)>& visit) const {
  const RayPlane plane(ray);
  walk(
      ray, [&] { return ray.t_max; },
      [&](std::uint32_t triangle) {
        if (const auto found = hit_triangle(mesh_, ray, plane, triangle)) visit(*found);
      });
}

std::optional<TriangleHit> TriangleBvh::first_hit(const WorldRay& ray) const {
  const RayPlane plane(ray);
  std::optional<TriangleHit> best;
  walk(
      ray, [&] { return best ? best->t + 16 * ulp * std::abs(best->t) : ray.t_max; },
      [&](std::uint32_t triangle) {
        const auto found = hit_triangle(mesh_, ray, plane, triangle);
        if (!found) return;
        if (!best || found->t < best->t || (found->t == best->t && found->triangle < best->triangle))
          best = found;
      });
  return best;
}

} // namespace levelray
