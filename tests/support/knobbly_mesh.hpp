// A closed mesh of the bunny's size that needs no file: an icosahedron's faces divided and pushed in and out.
#pragma once

#include "levelray/mesh/triangle_mesh.hpp"

#include <cmath>
#include <map>
#include <utility>

namespace levelray::test {

// 20 * 4^levels outward triangles (81,920 by default) around the origin, radii between 0.55 and 1.15, with
// knobs and hollows of several sizes.
inline TriangleMesh knobbly_mesh(int levels = 6) {
  const double g = (1 + std::sqrt(5.0)) / 2;
  TriangleMesh mesh;
  mesh.vertices = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                   {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  mesh.triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                    {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                    {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto [at, is_new] =
          middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(mesh.vertices.size()));
      if (is_new) mesh.vertices.push_back((mesh.vertices[a] + mesh.vertices[b]).normalized());
      return at->second;
    };
    std::vector<Triangle> divided;
    for (const Triangle& t : mesh.triangles) {
      const std::uint32_t a = middle(t[0], t[1]), b = middle(t[1], t[2]), c = middle(t[2], t[0]);
      divided.insert(divided.end(), {{t[0], a, c}, {t[1], b, a}, {t[2], c, b}, {a, b, c}});
    }
    mesh.triangles = std::move(divided);
  }
  for (Vec3d& v : mesh.vertices) {
    v.normalize();
    v *= 0.85 + 0.15 * std::sin(5 * v.x) * std::cos(4 * v.y + 1) + 0.1 * std::sin(9 * v.z + 2 * v.x) +
         0.05 * std::sin(23 * v.y) * std::cos(19 * v.z);
  }
  return mesh;
}

} // namespace levelray::test
