// What must hold on any closed mesh: solid angles sum to whole numbers, and pseudonormals tell the same side.
#include "levelray/measure/made_meshes.hpp"
#include "levelray/mesh/prepare.hpp"
#include "levelray/mesh/pseudonormal.hpp"
#include "levelray/mesh/triangle_bvh.hpp"
#include "levelray/mesh/winding_number.hpp"
#include "support/catch.hpp"

#include <random>

using namespace levelray;

namespace {

// A wedge with an angle of 2 atan(0.05) along its sharp edge, whose faces are split so that the edge's middle
// is a vertex of one side only, with a triangle without area in between.
TriangleMesh wedge_with_t_junction() {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0},     {0, 0, 2},     {1, 0.05, 0}, {1, 0.05, 2},
                   {1, -0.05, 0}, {1, -0.05, 2}, {0, 0, 0.8}};
  mesh.triangles = {{0, 6, 2}, {6, 3, 2}, {6, 1, 3},             // upper side, split at the edge's vertex 6
                    {0, 4, 5}, {0, 5, 1}, {0, 1, 6},             // lower side, whole, and the flat one
                    {2, 3, 5}, {2, 5, 4}, {0, 2, 4}, {1, 5, 3}}; // back and caps
  return mesh;
}

std::vector<std::pair<std::string, TriangleMesh>> closed_meshes() {
  return {{"tetrahedron", tetrahedron_mesh()},
          {"box", box_mesh()},
          {"torus", torus_mesh(30, 17, 2, 0.7)},
          {"thin torus", torus_mesh(60, 5, 2, 0.01)},
          {"hollow", joined_meshes(box_mesh(Vec3d(-2), Vec3d(3)), inverted_mesh(box_mesh()))},
          {"wedge", wedge_with_t_junction()},
          {"far", moved_mesh(torus_mesh(30, 17, 2, 0.7), Vec3d(1e7, -1e7, 1e7))}};
}

} // namespace

TEST_CASE("solid angles of a closed mesh sum to a whole number of spheres") {
  for (const auto& [name, mesh] : closed_meshes()) {
    const PreparedMesh prepared = prepare_mesh(mesh);
    REQUIRE(prepared.open_edges.empty());
    CHECK(prepared.report.flipped_triangles == 0);
    std::mt19937_64 random(30);
    const Vec3d size = prepared.report.bounds.size(), middle = prepared.report.bounds.center();
    std::uniform_real_distribution<double> uniform(-0.6, 0.6);
    int inside = 0;
    for (int i = 0; i < 500; ++i) {
      const Vec3d p = middle + Vec3d(uniform(random), uniform(random), uniform(random)) * size;
      const double w = winding_number(prepared.mesh, p);
      CAPTURE(name, i, p, w);
      // A solid angle has an error of a few ulp of 2 pi where the determinant's sign is sure: 1e-12 is ten
      // ulp for each of a thousand triangles. All points drawn are that far from the surface, or the test
      // would tell.
      CHECK(std::abs(w - std::round(w)) < 1e-12);
      CHECK((std::round(w) == 0 || std::round(w) == 1));
      inside += w > 0.5;
    }
    CHECK(inside > 0);
  }
}

TEST_CASE("pseudonormals tell the same side as the winding number on closed meshes") {
  for (const auto& [name, mesh] : closed_meshes()) {
    const PreparedMesh prepared = prepare_mesh(mesh);
    const TriangleBvh bvh(prepared.mesh);
    const Pseudonormals normals(prepared.mesh);
    std::mt19937_64 random(31);
    const Vec3d size = prepared.report.bounds.size(), middle = prepared.report.bounds.center();
    std::uniform_real_distribution<double> uniform(-0.7, 0.7);
    int features[7] = {};
    for (int i = 0; i < 2000; ++i) {
      const Vec3d p = middle + Vec3d(uniform(random), uniform(random), uniform(random)) * size;
      const auto q = bvh.closest_point(p);
      REQUIRE(q);
      ++features[q->feature];
      const double side = (p - q->point).dot(normals.at(q->triangle, q->feature));
      CAPTURE(name, i, p, q->point, q->triangle, q->feature, side);
      CHECK((side < 0) == (winding_number(prepared.mesh, p) > 0.5));
    }
    CHECK(features[0] + features[1] + features[2] > 0);
    CHECK(features[3] + features[4] + features[5] > 0);
    CHECK(features[6] > 0);
  }
}

TEST_CASE("a pseudonormal at an edge and at a vertex is the angle-weighted mean of its faces' normals") {
  const PreparedMesh prepared = prepare_mesh(box_mesh());
  const Pseudonormals normals(prepared.mesh);
  for (std::uint32_t t = 0; t < prepared.mesh.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      const Vec3d corner = prepared.mesh.vertices[prepared.mesh.triangles[t][static_cast<std::size_t>(k)]];
      const Vec3d outward = (corner - Vec3d(0.5)).normalized();
      // Each of three faces has a right angle there, of one triangle or two.
      CHECK((normals.at(t, k).normalized() - outward).length() < 1e-15);
      const Vec3d next =
          prepared.mesh.vertices[prepared.mesh.triangles[t][static_cast<std::size_t>((k + 1) % 3)]];
      const Vec3d edge = ((corner + next) / 2 - Vec3d(0.5)).normalized();
      CHECK((normals.at(t, feature_edge + k).normalized() - edge).length() < 1e-15);
    }
}
