#include "levelray/mesh/pseudonormal.hpp"

#include "levelray/core/parallel.hpp"
#include "levelray/mesh/edge_table.hpp"
#include "levelray/mesh/topology.hpp"

#include <array>
#include <cmath>
#include <numbers>

namespace levelray {

namespace {

constexpr std::size_t grain = 16384;

Vec3d unit_or_zero(const Vec3d& v) {
  const double length = v.length();
  return length > 0 ? v / length : Vec3d(0);
}

// A triangle without area, and what it passes on.
struct Flat {
  std::uint32_t triangle;
  std::uint32_t longest;                                      // its half-edge
  std::array<Vec3d, 3> towards{Vec3d(0), Vec3d(0), Vec3d(0)}; // unit normal that it shows at each half-edge
};

// Normals that triangles without area show to their edges. Chains of them pass normals on, one link a round.
std::vector<Flat> borrow_normals(const TriangleMesh& mesh, const EdgeTable& edges,
                                 const std::vector<std::uint32_t>& edge_of, const std::vector<Vec3d>& faces) {
  std::vector<Flat> flats;
  std::vector<std::uint32_t> flat_of(mesh.triangles.size(), no_index);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    if (faces[t] != Vec3d(0)) continue;
    Flat flat{t, 3 * t};
    double longest = -1;
    for (std::uint32_t h = 3 * t; h < 3 * t + 3; ++h) {
      const double length =
          (mesh.vertices[edge_end(mesh.triangles, h)] - mesh.vertices[edge_start(mesh.triangles, h)])
              .length();
      if (length > longest) longest = length, flat.longest = h;
    }
    flat_of[t] = static_cast<std::uint32_t>(flats.size());
    flats.push_back(flat);
  }
  const auto across = [&](std::uint32_t h) { // what the others at the edge show
    Vec3d sum(0);
    for (const std::uint32_t g : edges.of(edge_of[h])) {
      if (g == h) continue;
      sum += flat_of[g / 3] == no_index ? faces[g / 3] : flats[flat_of[g / 3]].towards[g % 3];
    }
    return sum;
  };
  constexpr int rounds = 64; // longer chains stay without a normal
  bool changed = true;
  for (int round = 0; changed && round < rounds; ++round) {
    changed = false;
    for (Flat& flat : flats) {
      const auto before = flat.towards;
      const std::uint32_t base = 3 * flat.triangle;
      const std::uint32_t k = flat.longest - base, k1 = (k + 1) % 3, k2 = (k + 2) % 3;
      flat.towards[k1] = flat.towards[k2] = unit_or_zero(across(flat.longest));
      flat.towards[k] = unit_or_zero(across(base + k1) + across(base + k2));
      changed |= flat.towards != before;
    }
  }
  return flats;
}

double angle_at(const TriangleMesh& mesh, std::uint32_t t, std::uint32_t k) {
  const Vec3d& p = mesh.vertices[mesh.triangles[t][k]];
  const Vec3d u = mesh.vertices[mesh.triangles[t][(k + 1) % 3]] - p;
  const Vec3d v = mesh.vertices[mesh.triangles[t][(k + 2) % 3]] - p;
  return std::atan2(u.cross(v).length(), u.dot(v));
}

} // namespace

Pseudonormals::Pseudonormals(const TriangleMesh& mesh)
    : faces_(mesh.triangles.size(), Vec3d(0)), vertices_(mesh.vertices.size(), Vec3d(0)),
      triangles_(mesh.triangles) {
  const EdgeTable edges = build_edge_table(mesh.triangles, mesh.vertices.size());
  edge_of_ = find_edges(edges);
  parallel_for(mesh.triangles.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      const Vec3d &a = mesh.vertices[triangles_[t][0]], &b = mesh.vertices[triangles_[t][1]],
                  &c = mesh.vertices[triangles_[t][2]];
      if (has_area(a, b, c)) faces_[t] = unit_or_zero((b - a).cross(c - a));
    }
  });
  const std::vector<Flat> flats = borrow_normals(mesh, edges, edge_of_, faces_);

  // Sum up around edges and vertices.
  edges_.assign(edges.size(), Vec3d(0));
  parallel_for(edges.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t e = begin; e < end; ++e)
      for (const std::uint32_t h : edges.of(e)) edges_[e] += faces_[h / 3];
  });
  for (std::uint32_t t = 0; t < triangles_.size(); ++t)
    if (faces_[t] != Vec3d(0))
      for (std::uint32_t k = 0; k < 3; ++k) vertices_[triangles_[t][k]] += faces_[t] * angle_at(mesh, t, k);
  for (const Flat& flat : flats) {
    for (std::uint32_t k = 0; k < 3; ++k) edges_[edge_of_[3 * flat.triangle + k]] += flat.towards[k];
    // The middle vertex is opposite to the longest edge and has an angle of pi; the others have none.
    const std::uint32_t middle = (flat.longest + 2 - 3 * flat.triangle) % 3;
    vertices_[triangles_[flat.triangle][middle]] += flat.towards[middle] * std::numbers::pi;
  }
}

const Vec3d& Pseudonormals::at(std::uint32_t triangle, int feature) const {
  if (feature == feature_face) return faces_[triangle];
  if (feature >= feature_edge)
    return edges_[edge_of_[3 * triangle + static_cast<std::uint32_t>(feature - feature_edge)]];
  return vertices_[triangles_[triangle][static_cast<std::size_t>(feature)]];
}

} // namespace levelray
