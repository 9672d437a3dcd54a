// A tree of boxes over a mesh's triangles: nearest points and rays in double precision, correct before fast.
//
// For tests, references and the few queries that preparing a mesh needs; rendering never sees it.
#pragma once

#include "levelray/core/ray.hpp"
#include "levelray/mesh/closest_point.hpp"

#include <functional>
#include <optional>

namespace levelray {

struct TriangleHit {
  double t = 0;
  std::uint32_t triangle = 0;
  bool front = false; // met on its counter-clockwise side: the ray runs against the normal
};

class TriangleBvh {
 public:
  // Splits at the median centre along the widest axis. Refers to `mesh`, which must outlive it unchanged.
  explicit TriangleBvh(const TriangleMesh& mesh);

  // The nearest point within `radius` (inclusive); the same as closest_point_brute_force finds.
  std::optional<MeshPoint> closest_point(const Vec3d& p,
                                         double radius = std::numeric_limits<double>::infinity()) const;

  // Calls visit(hit) for every triangle that the ray crosses in [t_min, t_max], in no order. Edges and
  // vertices leak nothing and count nothing twice: a ray crosses a closed mesh inward as often as outward,
  // exactly. The direction must not be zero.
  void all_hits(const WorldRay& ray, const std::function<void(const TriangleHit&)>& visit) const;

  // The first of them; at equal t the lowest triangle.
  std::optional<TriangleHit> first_hit(const WorldRay& ray) const;

 private:
  struct Node {
    Vec3d min{0, 0, 0}, max{0, 0, 0};
    std::uint32_t first = 0; // of its triangles in order_, or its left child; the right one follows that
    std::uint32_t count = 0; // 0: inner node
  };

  // Calls visit(triangle) for the triangles of all leaves whose boxes the ray meets before limit().
  template <class Limit, class Visit>
  void walk(const WorldRay& ray, Limit&& limit, Visit&& visit) const;

  const TriangleMesh& mesh_;
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> order_;
};

} // namespace levelray
