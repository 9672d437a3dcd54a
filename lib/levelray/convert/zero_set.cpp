#include "levelray/convert/zero_set.hpp"

#include <cassert>
#include <cmath>
#include <utility>

namespace levelray {

namespace {

constexpr int most_points =
    (max_zero_set_divisions + 1) * (max_zero_set_divisions + 1) * (max_zero_set_divisions + 1);

// Exact at 0 and 1, so that neighbouring cells agree on their common face.
double mix(double a, double b, double t) {
  return (1 - t) * a + t * b;
}

double interpolate(const std::array<float, 8>& f, const Vec3d& p) {
  const double y0z0 = mix(f[0], f[1], p.x), y1z0 = mix(f[2], f[3], p.x);
  const double y0z1 = mix(f[4], f[5], p.x), y1z1 = mix(f[6], f[7], p.x);
  return mix(mix(y0z0, y1z0, p.y), mix(y0z1, y1z1, p.y), p.z);
}

// Where the interpolant changes its sign between a (negative) and b (not negative), whose values are fa, fb.
// Along a diagonal it is a cubic, and nearly linear: the Illinois rule (Dowell and Jarratt 1971) is within
// 1e-9 of the edge after a handful of steps.
Vec3d crossing(const std::array<float, 8>& f, const Vec3d& a, double fa, const Vec3d& b, double fb) {
  double low = 0, high = 1, t = 0;
  int last = 0; // the side that moved last
  for (int step = 0; step < 20; ++step) {
    t = low + (high - low) * (fa / (fa - fb)); // fa < 0 <= fb: not outside low .. high
    const double value = interpolate(f, a + (b - a) * t);
    const double moved = value < 0 ? t - low : high - t;
    if (value == 0 || !(moved > 1e-9)) break;
    if (value < 0) {
      low = t, fa = value;
      if (last < 0) fb /= 2;
      last = -1;
    } else {
      high = t, fb = value;
      if (last > 0) fa /= 2;
      last = 1;
    }
  }
  return a + (b - a) * t;
}

// The six tetrahedra of a cube around the diagonal from corner 0 to corner 7.
constexpr int tetrahedra[6][4] = {{0, 1, 3, 7}, {0, 1, 5, 7}, {0, 2, 3, 7},
                                  {0, 2, 6, 7}, {0, 4, 5, 7}, {0, 4, 6, 7}};

} // namespace

void append_zero_set(const std::array<float, 8>& corners, const Vec3d& at, int divisions,
                     TriangleMesh& mesh) {
  assert(divisions >= 1 && divisions <= max_zero_set_divisions);
  const int side = divisions + 1;
  std::array<double, most_points> values;
  const auto index = [&](int x, int y, int z) { return static_cast<std::size_t>(x + side * (y + side * z)); };
  const auto place = [&](int x, int y, int z) {
    return Vec3d(double{1.0 * x} / divisions, double{1.0 * y} / divisions, double{1.0 * z} / divisions);
  };
  for (int z = 0; z < side; ++z)
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x) values[index(x, y, z)] = interpolate(corners, place(x, y, z));

  const auto add = [&](const Vec3d& a, const Vec3d& b, const Vec3d& c) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const Vec3d& v : {a, b, c}) mesh.vertices.push_back(at + v);
    mesh.triangles.push_back({first, first + 1, first + 2});
  };
  for (int z = 0; z < divisions; ++z)
    for (int y = 0; y < divisions; ++y)
      for (int x = 0; x < divisions; ++x) {
        std::array<double, 8> value;
        int negative = 0;
        for (int c = 0; c < 8; ++c) {
          value[static_cast<std::size_t>(c)] = values[index(x + (c & 1), y + (c >> 1 & 1), z + (c >> 2))];
          negative += value[static_cast<std::size_t>(c)] < 0;
        }
        if (negative == 0 || negative == 8) continue;
        for (const auto& tetrahedron : tetrahedra) {
          // Corners inside and outside; every pair of them is an edge with a crossing.
          int in[4], out[4], ins = 0, outs = 0;
          for (const int c : tetrahedron)
            (value[static_cast<std::size_t>(c)] < 0 ? in[ins++] : out[outs++]) = c;
          if (ins == 0 || outs == 0) continue;
          const auto cross = [&](int a, int b) {
            return crossing(corners, place(x + (a & 1), y + (a >> 1 & 1), z + (a >> 2)),
                            value[static_cast<std::size_t>(a)],
                            place(x + (b & 1), y + (b >> 1 & 1), z + (b >> 2)),
                            value[static_cast<std::size_t>(b)]);
          };
          if (ins == 1) {
            add(cross(in[0], out[0]), cross(in[0], out[1]), cross(in[0], out[2]));
          } else if (outs == 1) {
            add(cross(in[0], out[0]), cross(in[1], out[0]), cross(in[2], out[0]));
          } else {
            const Vec3d a = cross(in[0], out[0]), b = cross(in[0], out[1]), c = cross(in[1], out[1]),
                        d = cross(in[1], out[0]);
            add(a, b, c);
            add(a, c, d);
          }
        }
      }
}

} // namespace levelray
