// The parts that signs are made of: crossings, caps, boundary windings, potentials.
#include "levelray/convert/boundary_winding.hpp"
#include "levelray/convert/caps.hpp"
#include "levelray/convert/crossing.hpp"
#include "levelray/convert/weighted_union_find.hpp"
#include "levelray/measure/made_meshes.hpp"
#include "levelray/mesh/winding_number.hpp"
#include "support/catch.hpp"

#include <map>
#include <numeric>
#include <random>

using namespace levelray;

namespace {

VoxelMesh voxel_mesh(const TriangleMesh& mesh) {
  return make_voxel_mesh(prepare_mesh(mesh), GridTransform{});
}

std::vector<std::uint32_t> all_of(const VoxelMesh& mesh) {
  std::vector<std::uint32_t> list(mesh.triangles.size());
  std::iota(list.begin(), list.end(), 0u);
  return list;
}

} // namespace

TEST_CASE(
    "crossings sum to zero around every lattice square, also where edges, corners and faces lie on samples") {
  // All coordinates are halves or wholes: samples on corners, edges and faces everywhere.
  const TriangleMesh shapes[] = {
      box_mesh(Vec3d(-3, -2, -1), Vec3d(2, 3, 4)), moved_mesh(tetrahedron_mesh(), Vec3d(-2, -2, -2), 5),
      joined_meshes(box_mesh(Vec3d(-3), Vec3d(1)), box_mesh(Vec3d(-1), Vec3d(3))),
      moved_mesh(tetrahedron_mesh(), Vec3d(0.5), 3), without_triangles(box_mesh(Vec3d(-3), Vec3d(3)), 3, 2)};
  for (const TriangleMesh& shape : shapes) {
    const VoxelMesh mesh = voxel_mesh(shape);
    const std::vector<std::uint32_t> list = all_of(mesh);
    const auto winding = [&](const Vec3i& p, int axis) {
      return cross_lattice_edge(mesh, list.data(), list.size(), p, axis).winding;
    };
    int wrong = 0, crossed = 0;
    for (int z = -6; z < 6; ++z)
      for (int y = -6; y < 6; ++y)
        for (int x = -6; x < 6; ++x)
          for (int a = 0; a < 3; ++a) {
            const int b = (a + 1) % 3;
            const Vec3i p(x, y, z);
            Vec3i along_a = p, along_b = p;
            ++along_a[a];
            ++along_b[b];
            wrong += winding(p, a) + winding(along_a, b) - winding(along_b, a) - winding(p, b) != 0;
            crossed += winding(p, a) != 0;
          }
    CHECK(wrong == 0);
    CHECK(crossed > 10);
  }
}

TEST_CASE("a crossing's winding is the change of the winding number") {
  const TriangleMesh torus = moved_mesh(torus_mesh(23, 17, 1, 0.4), Vec3d(0.21, 0.13, -0.4), 7);
  const VoxelMesh mesh = voxel_mesh(torus);
  const std::vector<std::uint32_t> list = all_of(mesh);
  int crossed = 0;
  for (int z = -5; z < 5; ++z)
    for (int y = -11; y < 11; ++y)
      for (int x = -11; x < 11; ++x)
        for (int axis = 0; axis < 3; ++axis) {
          Vec3i q(x, y, z);
          ++q[axis];
          const double change =
              winding_number(torus, Vec3d(q.x, q.y, q.z)) - winding_number(torus, Vec3d(x, y, z));
          const Crossings found = cross_lattice_edge(mesh, list.data(), list.size(), Vec3i(x, y, z), axis);
          REQUIRE(found.winding == std::lround(change));
          crossed += found.triangles != 0;
        }
  CHECK(crossed > 100);
}

TEST_CASE("caps have the chain as their boundary, whatever its loops look like") {
  using Edges = std::vector<std::array<std::uint32_t, 2>>;
  const Edges chains[] = {
      {{0, 1}, {1, 2}, {2, 0}},                                 // a triangle
      {{0, 1}, {1, 2}, {2, 3}, {3, 4}, {4, 5}, {5, 6}, {6, 0}}, // a heptagon
      {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {3, 4}, {4, 0}},         // two loops at a vertex
      {{0, 1}, {1, 2}, {2, 0}, {0, 1}, {1, 2}, {2, 0}},         // a loop twice
      {{5, 4}, {4, 9}, {9, 5}, {7, 8}, {8, 7}},                 // one loop and one there-and-back
      {{0, 1}, {1, 2}, {2, 3}, {3, 1}, {1, 4}, {4, 0}},         // a figure of eight
  };
  for (const Edges& chain : chains) {
    std::map<std::array<std::uint32_t, 2>, int> count;
    const auto add = [&](std::uint32_t a, std::uint32_t b, int n) {
      count[{std::min(a, b), std::max(a, b)}] += a < b ? n : -n;
    };
    for (const auto& [a, b] : chain) add(a, b, -1);
    for (const Triangle& t : close_boundary(chain))
      for (std::size_t i = 0; i < 3; ++i) add(t[i], t[(i + 1) % 3], 1);
    for (const auto& [edge, n] : count) CHECK(n == 0);
  }
}

TEST_CASE("the winding of an open mesh is an integer less the winding of its caps") {
  const TriangleMesh open =
      moved_mesh(without_triangles(torus_mesh(30, 20, 1, 0.4), 40, 90), Vec3d(0.3, 0.1, 0.2), 9);
  const VoxelMesh mesh = voxel_mesh(open);
  REQUIRE(mesh.has_caps());
  const BoundaryWinding boundary(mesh);
  std::mt19937_64 rng(7);
  std::uniform_real_distribution<double> uniform(-14, 14);
  double worst_estimate = 0;
  for (int i = 0; i < 3000; ++i) {
    const Vec3d p(uniform(rng), uniform(rng), uniform(rng) / 2);
    const double exact = boundary.exact(p), sum = winding_number(open, p) + exact;
    // 1e-5: the caps are seen from a point that is moved by 1e-6 voxel, whose effect grows near an edge only.
    CHECK(std::abs(sum - std::round(sum)) < 1e-5);
    const BoundaryWinding::Estimate estimate = boundary.estimate(p);
    CHECK(std::abs(estimate.value - exact) <= estimate.error);
    worst_estimate = std::max(worst_estimate, estimate.error);

    const double radius = 0.5, variation = boundary.variation(p, radius);
    if (variation > 0.4) continue; // near the rim, where a cap may cut the ball
    const Vec3d q = p + Vec3d(uniform(rng), uniform(rng), uniform(rng)).normalized() * radius;
    const double change = std::abs(boundary.exact(q) - exact);
    CHECK(std::min(change, std::abs(1 - change)) <=
          variation + 1e-9); // 1 when the ball is cut by a cap after all
  }
  CHECK(worst_estimate > 1e-8); // else nothing was estimated
}

TEST_CASE("potentials add up along any path, and contradictions are told") {
  WeightedUnionFind sets(6);
  CHECK(sets.unite(3, 1, 2));
  CHECK(sets.unite(1, 5, -7));
  CHECK(sets.unite(0, 4, 1));
  CHECK(sets.unite(4, 3, 10));
  CHECK(sets.find(5).root == sets.find(0).root);
  CHECK(sets.find(5).offset - sets.find(0).offset == 1 + 10 + 2 - 7);
  CHECK(sets.unite(0, 1, 13));
  CHECK_FALSE(sets.unite(0, 1, 12));
  CHECK(sets.find(2).root == 2);
}
