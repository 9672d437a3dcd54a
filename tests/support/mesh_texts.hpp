// Small meshes as files of each format, made in memory, and what the readers say about them.
#pragma once

#include "levelray/core/error.hpp"
#include "levelray/io/mesh_reader.hpp"
#include "support/catch.hpp"

#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <string>
#include <vector>

namespace levelray::test {

using Polygons = std::vector<std::vector<std::uint32_t>>;

struct PolygonMesh {
  std::vector<Vec3d> vertices;
  Polygons polygons;
};

inline PolygonMesh tetrahedron() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
}

// A box of quads, off the origin.
inline PolygonMesh box() {
  PolygonMesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.vertices.push_back({1.5 + (i & 1), -2.25 + (i >> 1 & 1), 10.125 + (i >> 2)});
  mesh.polygons = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  return mesh;
}

inline std::string obj_text(const PolygonMesh& mesh) {
  std::string text;
  for (const Vec3d& v : mesh.vertices) text += fmt::format("v {} {} {}\n", v.x, v.y, v.z);
  for (const auto& polygon : mesh.polygons) {
    text += "f";
    for (const std::uint32_t v : polygon) text += fmt::format(" {}", v + 1);
    text += "\n";
  }
  return text;
}

inline std::string off_text(const PolygonMesh& mesh) {
  std::string text = fmt::format("OFF\n{} {} 0\n", mesh.vertices.size(), mesh.polygons.size());
  for (const Vec3d& v : mesh.vertices) text += fmt::format("{} {} {}\n", v.x, v.y, v.z);
  for (const auto& polygon : mesh.polygons) {
    text += fmt::format("{}", polygon.size());
    for (const std::uint32_t v : polygon) text += fmt::format(" {}", v);
    text += "\n";
  }
  return text;
}

inline std::string ply_header(const std::string& format, std::size_t vertices, std::size_t faces,
                              const std::string& coordinate = "float", const std::string& count = "uchar",
                              const std::string& index = "int") {
  return fmt::format("ply\nformat {} 1.0\nelement vertex {}\nproperty {} x\nproperty {} y\nproperty {} z\n"
                     "element face {}\nproperty list {} {} vertex_indices\nend_header\n",
                     format, vertices, coordinate, coordinate, coordinate, faces, count, index);
}

inline std::string ply_text(const PolygonMesh& mesh) {
  std::string text = ply_header("ascii", mesh.vertices.size(), mesh.polygons.size());
  const std::string off = off_text(mesh);
  return text + off.substr(off.find('\n', 4) + 1);
}

// The bytes of `value` in the order asked for.
template <class T>
std::string bytes_of(T value, bool big = false) {
  std::string bytes(sizeof(T), '\0');
  std::memcpy(bytes.data(), &value, sizeof(T));
  return big ? std::string(bytes.rbegin(), bytes.rend()) : bytes;
}

inline std::string ply_binary(const PolygonMesh& mesh, bool big) {
  std::string bytes = ply_header(big ? "binary_big_endian" : "binary_little_endian", mesh.vertices.size(),
                                 mesh.polygons.size());
  for (const Vec3d& v : mesh.vertices)
    for (const double x : {v.x, v.y, v.z}) bytes += bytes_of(static_cast<float>(x), big);
  for (const auto& polygon : mesh.polygons) {
    bytes += static_cast<char>(polygon.size());
    for (const std::uint32_t v : polygon) bytes += bytes_of(v, big);
  }
  return bytes;
}

// STL has triangles only: fans of the polygons.
inline std::vector<Triangle> fans(const PolygonMesh& mesh) {
  std::vector<Triangle> triangles;
  for (const auto& p : mesh.polygons)
    for (std::size_t i = 1; i + 1 < p.size(); ++i) triangles.push_back({p[0], p[i], p[i + 1]});
  return triangles;
}

inline std::string stl_text(const PolygonMesh& mesh, const std::string& name = "thing") {
  std::string text = "solid " + name + "\n";
  for (const Triangle& t : fans(mesh)) {
    text += " facet normal 0 0 0\n  outer loop\n";
    for (const std::uint32_t v : t)
      text += fmt::format("   vertex {} {} {}\n", mesh.vertices[v].x, mesh.vertices[v].y, mesh.vertices[v].z);
    text += "  endloop\n endfacet\n";
  }
  return text + "endsolid " + name + "\n";
}

inline std::string stl_binary(const PolygonMesh& mesh, std::string header = "made by a test") {
  header.resize(80, ' ');
  const std::vector<Triangle> triangles = fans(mesh);
  std::string bytes = header + bytes_of(static_cast<std::uint32_t>(triangles.size()));
  for (const Triangle& t : triangles) {
    bytes += std::string(12, '\0');
    for (const std::uint32_t v : t)
      for (const double x : {mesh.vertices[v].x, mesh.vertices[v].y, mesh.vertices[v].z})
        bytes += bytes_of(static_cast<float>(x));
    bytes += std::string(2, '\0');
  }
  return bytes;
}

inline MeshFile parsed(const std::string& bytes, const std::string& name,
                       const MeshReadOptions& options = {}) {
  return parse_mesh(bytes.data(), bytes.size(), name, options);
}

// The message of the Error that these bytes must end in.
inline std::string refusal(const std::string& bytes, const std::string& name,
                           const MeshReadOptions& options = {}, ErrorKind kind = ErrorKind::bad_input) {
  try {
    const MeshFile file = parsed(bytes, name, options);
    FAIL("read " << file.mesh.triangles.size() << " triangles where an error should be");
  } catch (const Error& error) {
    CHECK(error.kind() == kind);
    return error.what();
  }
  return "";
}

inline double signed_volume(const TriangleMesh& mesh) {
  double sum = 0;
  if (mesh.vertices.empty()) return 0;
  const Vec3d origin = mesh.vertices[0];
  for (const Triangle& t : mesh.triangles)
    sum += (mesh.vertices[t[0]] - origin)
               .dot((mesh.vertices[t[1]] - origin).cross(mesh.vertices[t[2]] - origin));
  return sum / 6;
}

inline double surface_area(const TriangleMesh& mesh) {
  double sum = 0;
  for (const Triangle& t : mesh.triangles)
    sum +=
        (mesh.vertices[t[1]] - mesh.vertices[t[0]]).cross(mesh.vertices[t[2]] - mesh.vertices[t[0]]).length();
  return sum / 2;
}

// Whether a mesh keeps what TriangleMesh promises.
inline bool is_sound(const TriangleMesh& mesh) {
  for (const Vec3d& v : mesh.vertices)
    if (!std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.z)) return false;
  for (const Triangle& t : mesh.triangles)
    for (const std::uint32_t v : t)
      if (v >= mesh.vertices.size()) return false;
  return true;
}

} // namespace levelray::test
