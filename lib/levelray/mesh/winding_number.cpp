#include "levelray/mesh/winding_number.hpp"

#include <cmath>
#include <numbers>

namespace levelray {

double solid_angle(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& p) {
  const Vec3d pa = a - p, pb = b - p, pc = c - p;
  // The paper's a.(b x c), as pa times the triangle's own normal: for small triangles far away that is a
  // product of accurate factors, where b x c would cancel.
  const double determinant = pa.dot((b - a).cross(c - a));
  if (!(determinant != 0)) return 0;
  const double la = pa.length(), lb = pb.length(), lc = pc.length();
  const double denominator = la * lb * lc + pa.dot(pb) * lc + pb.dot(pc) * la + pc.dot(pa) * lb;
  return 2 * std::atan2(determinant, denominator);
}

double winding_number(const TriangleMesh& mesh, const Vec3d& p) {
  // Neumaier 1974, algorithm IV: compensated, so that a million terms keep the error of a few.
  double sum = 0, lost = 0;
  for (const Triangle& t : mesh.triangles) {
    const double term = solid_angle(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]], p);
    const double next = sum + term;
    lost += std::abs(sum) >= std::abs(term) ? (sum - next) + term : (term - next) + sum;
    sum = next;
  }
  return (sum + lost) / (4 * std::numbers::pi);
}

} // namespace levelray
