#include "levelray/convert/crossing.hpp"

#include <algorithm>

namespace levelray {

namespace {

using Int128 = __int128;

int sign_of(Int128 x) {
  return (x > 0) - (x < 0);
}

// The side of the moved point P of the directed edge a -> b in the plane (u, v): +1 left, -1 right, never 0
// unless a == b there. The determinant is (b-a).u (P-a).v - (b-a).v (P-a).u; where it vanishes, the larger
// infinitesimal of the two decides.
int edge_side(const FixedPoint& a, const FixedPoint& b, const FixedPoint& p, std::size_t u, std::size_t v) {
  const std::int64_t du = b[u] - a[u], dv = b[v] - a[v];
  const int side = sign_of(Int128{du} * (p[v] - a[v]) - Int128{dv} * (p[u] - a[u]));
  if (side != 0) return side;
  const int by_u = sign_of(-Int128{dv}), by_v = sign_of(Int128{du});
  return u < v ? (by_u != 0 ? by_u : by_v) : (by_v != 0 ? by_v : by_u);
}

} // namespace

Crossings cross_lattice_edge(const VoxelMesh& mesh, const std::uint32_t* list, std::size_t count,
                             const Vec3i& p, int axis) {
  const std::size_t w = static_cast<std::size_t>(axis), u = (w + 1) % 3, v = (w + 2) % 3;
  const std::int64_t one = std::int64_t{1} << mesh.fraction_bits;
  const FixedPoint from{p.x * one, p.y * one, p.z * one};

  Crossings found;
  for (std::size_t i = 0; i < count; ++i) {
    const Triangle& t = mesh.triangles[list[i]];
    const FixedPoint &a = mesh.fixed[t[0]], &b = mesh.fixed[t[1]], &c = mesh.fixed[t[2]];

    // Leave early when the boxes of segment and triangle are apart. Closed comparisons: the movement only
    // matters on contact.
    if (std::max({a[u], b[u], c[u]}) < from[u] || std::min({a[u], b[u], c[u]}) > from[u]) continue;
    if (std::max({a[v], b[v], c[v]}) < from[v] || std::min({a[v], b[v], c[v]}) > from[v]) continue;
    if (std::max({a[w], b[w], c[w]}) < from[w] || std::min({a[w], b[w], c[w]}) > from[w] + one) continue;

    // Does the line through the segment pass between the edges? Then the triangle's projection has area and
    // its normal's component along the axis has the sign of the three sides.
    const int side = edge_side(a, b, from, u, v);
    if (side == 0 || edge_side(b, c, from, u, v) != side || edge_side(c, a, from, u, v) != side) continue;

    // Do the segment's ends lie on different sides of the plane? D(P) = n . (P - a) grows along the axis by
    // n_w per unit.
    const std::int64_t e1[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
    const std::int64_t e2[3] = {c[0] - a[0], c[1] - a[1], c[2] - a[2]};
    const Int128 n[3] = {Int128{e1[1]} * e2[2] - Int128{e1[2]} * e2[1],
                         Int128{e1[2]} * e2[0] - Int128{e1[0]} * e2[2],
                         Int128{e1[0]} * e2[1] - Int128{e1[1]} * e2[0]};
    const Int128 at_start = n[0] * (from[0] - a[0]) + n[1] * (from[1] - a[1]) + n[2] * (from[2] - a[2]);
    const Int128 at_end = at_start + n[w] * one;
    const int moved = n[0] != 0 ? sign_of(n[0]) : n[1] != 0 ? sign_of(n[1]) : sign_of(n[2]);
    const int start = at_start != 0 ? sign_of(at_start) : moved;
    const int end = at_end != 0 ? sign_of(at_end) : moved;
    if (start == end) continue;

    // Along the normal one leaves the inside: the winding number falls by one.
    ++found.triangles;
    found.winding -= side;
  }
  return found;
}

} // namespace levelray
