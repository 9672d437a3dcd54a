// Shapes and rays for tests of tracing.
#pragma once

#include "levelray/core/ray.hpp"
#include "support/sphere_grid.hpp"

#include <random>
#include <string>
#include <vector>

namespace levelray::test {

struct Shape {
  std::string name;
  BlockGrid grid;
};

// Unit voxels; `shift` moves everything by whole samples.
inline BlockGrid torus_grid(double radius, double tube, const Vec3d& shift = Vec3d(0, 0, 0)) {
  const Vec3d centre = Vec3d(-3.2, 1.3, 0.6) + shift;
  const Vec3d axis = Vec3d(0.3, 0.9, 0.4).normalized();
  const auto field = [=](const Vec3d& p) {
    const Vec3d q = p - centre;
    const double h = q.dot(axis), r = std::sqrt(std::max(0.0, q.dot(q) - h * h)) - radius;
    return std::sqrt(r * r + h * h) - tube;
  };
  const double e = radius + tube + 5;
  return sample_grid(field, 1, 3, Box3d(centre - Vec3d(e, e + 9, e), centre + Vec3d(e, e, e + 20)));
}

// A slab of that thickness, tilted, cut off by a box, so that it is a closed plate.
inline BlockGrid slab_grid(double thickness, double half_size = 20, const Vec3d& shift = Vec3d(0, 0, 0)) {
  const Vec3d centre = Vec3d(0.4, -2.7, 1.1) + shift;
  const Vec3d n = Vec3d(0.42, 0.31, 0.85).normalized();
  const Vec3d u = n.cross(Vec3d(0, 0, 1)).normalized(), v = n.cross(u);
  const auto field = [=](const Vec3d& p) {
    const Vec3d q = p - centre;
    const double a = std::fabs(q.dot(n)) - thickness / 2, b = std::fabs(q.dot(u)) - half_size,
                 c = std::fabs(q.dot(v)) - half_size;
    const double x = std::max(a, 0.0), y = std::max(b, 0.0), z = std::max(c, 0.0);
    return std::sqrt(x * x + y * y + z * z) + std::min(std::max(a, std::max(b, c)), 0.0);
  };
  const double e = half_size * 1.5 + 5;
  return sample_grid(field, 1, 3, Box3d(centre - Vec3d(e, e, e + 11), centre + Vec3d(e + 7, e, e)));
}

// A gyroid sheet, about 1.5 voxels thick, cut off by a ball.
inline BlockGrid gyroid_grid(double ball = 24, const Vec3d& shift = Vec3d(0, 0, 0)) {
  const Vec3d centre = Vec3d(1.7, 0.2, -4.1) + shift;
  const auto field = [=](const Vec3d& p) {
    const Vec3d q = (p - centre) * 0.35;
    const double g =
        std::sin(q.x) * std::cos(q.y) + std::sin(q.y) * std::cos(q.z) + std::sin(q.z) * std::cos(q.x);
    return std::max(std::fabs(g) / (0.35 * 1.5) - 0.75, (p - centre).length() - ball);
  };
  const double e = ball + 4;
  return sample_grid(field, 1, 3, Box3d(centre - Vec3d(e, e, e), centre + Vec3d(e + 18, e, e + 5)));
}

// Uniform directions and points.
class RandomRays {
 public:
  explicit RandomRays(unsigned seed) : engine_(seed) {}

  double uniform(double low, double high) { return low + (high - low) * unit_(engine_); }
  Vec3d in_box(const Box3d& box) {
    return Vec3d(uniform(box.min.x, box.max.x), uniform(box.min.y, box.max.y), uniform(box.min.z, box.max.z));
  }
  Vec3d direction() {
    for (;;) {
      const Vec3d d(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1));
      const double l = d.length();
      if (l > 0.1 && l <= 1) return d / l;
    }
  }
  // A ray from well outside through a random point of the box.
  WorldRay through(const Box3d& box) {
    const Vec3d d = direction();
    WorldRay ray;
    ray.direction = d;
    ray.origin = in_box(box) - d * (2 * (box.max - box.min).length());
    return ray;
  }

 private:
  std::mt19937_64 engine_;
  std::uniform_real_distribution<double> unit_{0, 1};
};

// The world box of the active samples.
inline Box3d active_box(const BlockGrid& grid) {
  const Box3i box = grid.active_bounds();
  return Box3d(grid.transform.to_world(Vec3d(box.min)), grid.transform.to_world(Vec3d(box.max)));
}

} // namespace levelray::test
