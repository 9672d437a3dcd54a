#include "levelray/measure/mesh_judge.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace levelray {

namespace {

// Squared distances from the origin.
Extended segment_squared(const Vec3x& a, const Vec3x& b) {
  const Vec3x e = b - a;
  const Extended length = e.dot(e);
  const Extended u = length > 0 ? std::clamp<Extended>(-a.dot(e) / length, 0, 1) : 0;
  const Vec3x q = a + e * u;
  return q.dot(q);
}

Extended triangle_squared(const Vec3x& a, const Vec3x& b, const Vec3x& c) {
  Extended best = std::min({segment_squared(a, b), segment_squared(b, c), segment_squared(c, a)});
  const Vec3x n = (b - a).cross(c - a);
  const Extended size = n.dot(n);
  if (!(size > 0)) return best;
  const Vec3x foot = n * (a.dot(n) / size);
  const auto left = [&](const Vec3x& from, const Vec3x& to) {
    return (to - from).cross(foot - from).dot(n) >= 0;
  };
  if (left(a, b) && left(b, c) && left(c, a)) best = std::min(best, foot.dot(foot));
  return best;
}

} // namespace

Extended mesh_distance(const TriangleMesh& mesh, const Vec3d& p) {
  Extended best = std::numeric_limits<Extended>::infinity();
  const Vec3x q(p);
  for (const Triangle& t : mesh.triangles)
    best = std::min(best, triangle_squared(Vec3x(mesh.vertices[t[0]]) - q, Vec3x(mesh.vertices[t[1]]) - q,
                                           Vec3x(mesh.vertices[t[2]]) - q));
  return std::sqrt(best);
}

Extended mesh_winding(const TriangleMesh& mesh, const Vec3d& p) {
  Extended sum = 0;
  const Vec3x q(p);
  for (const Triangle& t : mesh.triangles) {
    const Vec3x a = Vec3x(mesh.vertices[t[0]]) - q, b = Vec3x(mesh.vertices[t[1]]) - q,
                c = Vec3x(mesh.vertices[t[2]]) - q;
    const Extended la = std::sqrt(a.dot(a)), lb = std::sqrt(b.dot(b)), lc = std::sqrt(c.dot(c));
    const Extended volume = a.dot(b.cross(c));
    const Extended rest = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
    if (volume != 0 || rest < 0) sum += 2 * std::atan2(volume, rest);
  }
  return sum / (4 * std::numbers::pi_v<Extended>);
}

} // namespace levelray
