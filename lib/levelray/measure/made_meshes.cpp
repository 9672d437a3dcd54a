#include "levelray/measure/made_meshes.hpp"

#include <cmath>
#include <numbers>
#include <utility>

namespace levelray {

TriangleMesh tetrahedron_mesh() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
}

TriangleMesh box_mesh(const Vec3d& min, const Vec3d& max) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.vertices.emplace_back(i & 1 ? max.x : min.x, i & 2 ? max.y : min.y, i & 4 ? max.z : min.z);
  mesh.triangles = {{0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}};
  return mesh;
}

TriangleMesh torus_mesh(std::uint32_t n, std::uint32_t m, double big, double small) {
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i < n; ++i)
    for (std::uint32_t j = 0; j < m; ++j) {
      const double u = 2 * std::numbers::pi * i / n, v = 2 * std::numbers::pi * j / m;
      const double r = big + small * std::cos(v);
      mesh.vertices.emplace_back(r * std::cos(u), r * std::sin(u), small * std::sin(v));
      const std::uint32_t a = i * m + j, b = (i + 1) % n * m + j, c = (i + 1) % n * m + (j + 1) % m,
                          d = i * m + (j + 1) % m;
      mesh.triangles.push_back({a, b, c});
      mesh.triangles.push_back({a, c, d});
    }
  return mesh;
}

TriangleMesh ball_mesh(std::uint32_t n, std::uint32_t m, double radius) {
  TriangleMesh mesh;
  const auto at = [&](std::uint32_t i, std::uint32_t j) {
    return j == 0 ? 0 : j == m ? 1 : 2 + (j - 1) * n + i % n;
  };
  mesh.vertices.resize(2 + std::size_t{n} * (m - 1));
  mesh.vertices[0] = Vec3d(0, 0, radius), mesh.vertices[1] = Vec3d(0, 0, -radius);
  for (std::uint32_t j = 1; j < m; ++j)
    for (std::uint32_t i = 0; i < n; ++i) {
      const double u = 2 * std::numbers::pi * i / n, v = std::numbers::pi * j / m;
      mesh.vertices[at(i, j)] =
          Vec3d(std::cos(u) * std::sin(v), std::sin(u) * std::sin(v), std::cos(v)) * radius;
    }
  for (std::uint32_t j = 0; j < m; ++j)
    for (std::uint32_t i = 0; i < n; ++i) {
      if (j > 0) mesh.triangles.push_back({at(i, j), at(i, j + 1), at(i + 1, j)});
      if (j + 1 < m) mesh.triangles.push_back({at(i + 1, j), at(i, j + 1), at(i + 1, j + 1)});
    }
  return mesh;
}

TriangleMesh joined_meshes(TriangleMesh a, const TriangleMesh& b) {
  const auto shift = static_cast<std::uint32_t>(a.vertices.size());
  a.vertices.insert(a.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (const Triangle& t : b.triangles) a.triangles.push_back({t[0] + shift, t[1] + shift, t[2] + shift});
  return a;
}

TriangleMesh moved_mesh(TriangleMesh mesh, const Vec3d& by, double scale) {
  for (Vec3d& v : mesh.vertices) v = v * scale + by;
  return mesh;
}

TriangleMesh without_triangles(TriangleMesh mesh, std::size_t first, std::size_t count) {
  mesh.triangles.erase(mesh.triangles.begin() + static_cast<std::ptrdiff_t>(first),
                       mesh.triangles.begin() + static_cast<std::ptrdiff_t>(first + count));
  return mesh;
}

TriangleMesh inverted_mesh(TriangleMesh mesh) {
  return turned_faces(std::move(mesh), 1);
}

TriangleMesh turned_faces(TriangleMesh mesh, int every) {
  for (std::size_t i = 0; i < mesh.triangles.size(); i += static_cast<std::size_t>(every))
    std::swap(mesh.triangles[i][1], mesh.triangles[i][2]);
  return mesh;
}

TriangleMesh moebius_mesh(std::uint32_t n) {
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i < n; ++i) {
    const double u = 2 * std::numbers::pi * i / n;
    for (const double w : {-0.3, 0.3}) {
      const double r = 1 + w * std::cos(u / 2);
      mesh.vertices.emplace_back(r * std::cos(u), r * std::sin(u), w * std::sin(u / 2));
    }
    const std::uint32_t a = 2 * i, b = a + 1, c = i + 1 < n ? a + 2 : 1, d = i + 1 < n ? a + 3 : 0;
    mesh.triangles.push_back({a, c, d});
    mesh.triangles.push_back({a, d, b});
  }
  return mesh;
}

TriangleMesh with_five_holes() {
  TriangleMesh mesh = torus_mesh(20, 12);
  for (const std::size_t hole : {400u, 300u, 211u, 120u, 31u}) // from the back, single quads and triangles
    mesh = without_triangles(std::move(mesh), hole, 1 + hole % 2);
  return mesh;
}

TriangleMesh with_degenerates() {
  TriangleMesh mesh = torus_mesh(16, 8);
  const std::size_t count = mesh.triangles.size();
  for (std::size_t i = 0; i < count; i += 9) {
    const Triangle t = mesh.triangles[i];
    mesh.triangles.push_back({t[0], t[0], t[1]});
    mesh.triangles.push_back({t[2], t[2], t[2]});
    const auto middle = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.push_back((mesh.vertices[t[0]] + mesh.vertices[t[1]]) / 2);
    mesh.triangles.push_back({t[0], middle, t[1]});
  }
  return mesh;
}

TriangleMesh with_slivers() {
  TriangleMesh mesh = box_mesh(Vec3d(0, 0, 0), Vec3d(1, 0.8, 0.6));
  mesh.triangles.resize(10); // without the upper face 4 5 7 6
  const auto middle = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.emplace_back(0.37, 1e-12, 0.6);
  for (const auto& [a, b] : {std::pair{4u, 5u}, {5u, 7u}, {7u, 6u}, {6u, 4u}})
    mesh.triangles.push_back({a, b, middle});
  return mesh;
}

TriangleMesh with_t_junctions() {
  TriangleMesh mesh = box_mesh(Vec3d(0, 0, 0), Vec3d(1, 0.8, 0.6));
  mesh.triangles.resize(10);
  mesh.vertices.emplace_back(0.5, 0, 0.6);   // 8
  mesh.vertices.emplace_back(0.5, 0.8, 0.6); // 9
  for (const Triangle& t : {Triangle{4, 8, 9}, {4, 9, 6}, {8, 5, 7}, {8, 7, 9}}) mesh.triangles.push_back(t);
  return mesh;
}

TriangleMesh boxes_with_a_common_edge() {
  TriangleMesh mesh = box_mesh(Vec3d(0, 0, 0), Vec3d(1, 1, 1));
  const TriangleMesh other = box_mesh(Vec3d(1, 1, 0), Vec3d(1.7, 1.7, 1)); // on the vertical edge at (1, 1)
  return joined_meshes(mesh, other);                                       // whose vertices weld
}

} // namespace levelray
