#include "levelray/mesh/closest_point.hpp"

#include <limits>

namespace levelray {

namespace {

// Keeps the nearer of `best` and the point at offset `q` from p.
void offer(TrianglePoint& best, const Vec3d& p, const Vec3d& q, int feature) {
  const double d2 = q.dot(q);
  if (d2 < best.distance_squared) best = {p + q, d2, feature};
}

// Nearest point to the origin on the inside of the segment (Ericson 2004, section 5.1.2); ends are corners.
void offer_edge(TrianglePoint& best, const Vec3d& p, const Vec3d& a, const Vec3d& b, int feature) {
  const Vec3d ab = b - a;
  const double from_a = -a.dot(ab), from_b = b.dot(ab); // both positive when the foot is inside
  if (!(from_a > 0 && from_b > 0)) return;
  // Start at the nearer end: the foot is then at most half the edge's rounding off.
  const double s = from_a / (from_a + from_b);
  offer(best, p, s < 0.5 ? a + ab * s : b - ab * (from_b / (from_a + from_b)), feature);
}

} // namespace

TrianglePoint closest_point_on_triangle(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& p) {
  const Vec3d corner[3] = {a - p, b - p, c - p};
  TrianglePoint best;
  best.distance_squared = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k) offer(best, p, corner[k], k);
  for (int k = 0; k < 3; ++k) offer_edge(best, p, corner[k], corner[(k + 1) % 3], feature_edge + k);

  // Areas of the triangles that the foot of the perpendicular makes with the edges, times twice the area's
  // square root of n.n: positive all three when it is inside.
  const Vec3d n = (b - a).cross(c - a);
  const double wa = corner[1].cross(corner[2] - corner[1]).dot(n);
  const double wb = corner[2].cross(corner[0] - corner[2]).dot(n);
  const double wc = corner[0].cross(corner[1] - corner[0]).dot(n);
  if (wa > 0 && wb > 0 && wc > 0) {
    const double sum = wa + wb + wc;
    offer(best, p, corner[0] * (wa / sum) + corner[1] * (wb / sum) + corner[2] * (wc / sum), feature_face);
  }
  if (best.feature < feature_edge) best.point = best.feature == 0 ? a : best.feature == 1 ? b : c;
  return best;
}

MeshPoint closest_point_brute_force(const TriangleMesh& mesh, const Vec3d& p) {
  MeshPoint best;
  best.distance_squared = std::numeric_limits<double>::infinity();
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    const TrianglePoint q =
        closest_point_on_triangle(mesh.vertices[a], mesh.vertices[b], mesh.vertices[c], p);
    if (q.distance_squared < best.distance_squared) static_cast<TrianglePoint&>(best) = q, best.triangle = t;
  }
  return best;
}

} // namespace levelray
