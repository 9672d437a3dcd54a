#include "levelray/mesh/prepare.hpp"

#include "levelray/core/error.hpp"
#include "levelray/core/parallel.hpp"
#include "levelray/measure/made_meshes.hpp"
#include "levelray/mesh/winding_number.hpp"
#include "support/catch.hpp"

using namespace levelray;

namespace {

bool warned(const PreparedMesh& mesh, const std::string& words) {
  for (const std::string& w : mesh.warnings)
    if (w.find(words) != std::string::npos) return true;
  return false;
}

// Solid angles of a few triangles carry a few ulp of 2 pi each; 1e-12 is a thousand of them.
Approx winding(double w) {
  return Approx(w).margin(1e-12);
}

const Vec3d middle(0.5, 0.5, 0.5);

} // namespace

TEST_CASE("a clean tetrahedron stays as it is and gives no warning") {
  const PreparedMesh mesh = prepare_mesh(tetrahedron_mesh());
  CHECK(mesh.mesh.triangles == tetrahedron_mesh().triangles);
  CHECK(mesh.mesh.vertices == tetrahedron_mesh().vertices);
  CHECK(mesh.warnings.empty());
  CHECK(mesh.open_edges.empty());
  const MeshReport& r = mesh.report;
  CHECK(r.closed);
  CHECK(r.orientation == Orientation::outward);
  CHECK(r.components == 1);
  CHECK(r.shells == 1);
  CHECK(r.boundary_edges + r.boundary_loops + r.non_manifold_edges + r.non_manifold_vertices +
            r.winding_clashes ==
        0);
  CHECK(r.volume == Approx(1.0 / 6));
  CHECK(r.bounds == Box3d(Vec3d(0), Vec3d(1)));
}

TEST_CASE("vertices weld by exact position, with minus zero equal to zero") {
  TriangleMesh soup; // the tetrahedron, three vertices a triangle, and one that nobody uses
  for (const Triangle& t : tetrahedron_mesh().triangles)
    for (const std::uint32_t v : t) soup.vertices.push_back(tetrahedron_mesh().vertices[v]);
  for (std::uint32_t t = 0; t < 4; ++t) soup.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  soup.vertices[0].x = -0.0;
  soup.vertices[3].z = -0.0;
  soup.vertices.emplace_back(7, 8, 9);
  const PreparedMesh mesh = prepare_mesh(soup);
  CHECK(mesh.mesh.vertices.size() == 4);
  CHECK(mesh.report.vertices == 13);
  CHECK(mesh.report.merged_vertices == 8);
  CHECK(mesh.report.unreferenced_vertices == 1);
  CHECK(mesh.report.closed);
  CHECK(mesh.report.bounds == Box3d(Vec3d(0), Vec3d(1)));
  for (const Vec3d& v : mesh.mesh.vertices)
    for (int i = 0; i < 3; ++i) CHECK_FALSE(std::signbit(v[i]));
}

TEST_CASE("a crack of one ulp is not welded") {
  TriangleMesh mesh = box_mesh();
  mesh.vertices.push_back(Vec3d(std::nextafter(1.0, 2), 1, 1));
  mesh.triangles[11] = {4, 8, 6};
  const PreparedMesh prepared = prepare_mesh(mesh);
  CHECK_FALSE(prepared.report.closed);
  CHECK(prepared.report.boundary_edges == 4);
  CHECK(prepared.open_edges.size() == 4);
}

TEST_CASE("an inverted mesh is turned, unless its orientation is trusted") {
  const PreparedMesh turned = prepare_mesh(inverted_mesh(box_mesh()));
  CHECK(turned.report.orientation == Orientation::inverted);
  CHECK(turned.report.flipped_triangles == 12);
  CHECK(turned.report.volume == Approx(1));
  CHECK(winding_number(turned.mesh, middle) == winding(1));
  CHECK(warned(turned, "inside out"));

  const PreparedMesh trusted = prepare_mesh(inverted_mesh(box_mesh()), {true});
  CHECK(trusted.report.orientation == Orientation::inverted);
  CHECK(trusted.report.flipped_triangles == 0);
  CHECK(trusted.mesh.triangles == inverted_mesh(box_mesh()).triangles);
  CHECK(trusted.report.volume == Approx(-1));
  CHECK(winding_number(trusted.mesh, middle) == winding(-1));
}

TEST_CASE("one flipped face is turned back, and nothing else") {
  for (std::size_t t = 0; t < 12; ++t) {
    TriangleMesh mesh = box_mesh();
    std::swap(mesh.triangles[t][0], mesh.triangles[t][1]);
    const PreparedMesh prepared = prepare_mesh(mesh);
    CHECK(prepared.report.orientation == Orientation::mixed);
    CHECK(prepared.report.winding_clashes == 3);
    CHECK(prepared.report.flipped_triangles == 1);
    CHECK(prepared.open_edges.empty());
    CHECK(prepared.report.volume == Approx(1));

    const PreparedMesh trusted = prepare_mesh(mesh, {true});
    CHECK(trusted.report.orientation == Orientation::mixed);
    CHECK(trusted.mesh.triangles == mesh.triangles);
    CHECK(trusted.open_edges.size() == 6); // each of three edges is missing two in one direction
  }
}

TEST_CASE("open edges close the boundary chain") {
  TriangleMesh mesh = without_triangles(box_mesh(), 10, 2);
  const PreparedMesh prepared = prepare_mesh(mesh);
  REQUIRE(prepared.open_edges.size() == 4);
  // Triangles over these edges with any apex complete the box's winding number to an integer.
  TriangleMesh capped = prepared.mesh;
  capped.vertices.emplace_back(0.3, 0.6, 1.2);
  for (const auto& e : prepared.open_edges)
    capped.triangles.push_back({e[0], e[1], static_cast<std::uint32_t>(capped.vertices.size() - 1)});
  CHECK(winding_number(capped, middle) == winding(1));
  CHECK(winding_number(capped, Vec3d(2, 3, 4)) == winding(0));
  CHECK(prepare_mesh(capped).report.closed);
  CHECK(prepare_mesh(capped).report.winding_clashes == 0);

  const MeshReport& r = prepared.report;
  CHECK_FALSE(r.closed);
  CHECK(r.boundary_edges == 4);
  CHECK(r.boundary_loops == 1);
  CHECK(r.longest_hole == Approx(std::sqrt(2.0)));
  CHECK(r.orientation == Orientation::outward);
  // The cap is the missing face, since the boundary's centroid lies in it.
  CHECK(r.volume == Approx(1));
  CHECK(warned(prepared, "4 boundary edges in 1 hole, the largest"));
}

TEST_CASE("an inverted open box is turned") {
  const PreparedMesh prepared = prepare_mesh(inverted_mesh(without_triangles(box_mesh(), 0, 2)));
  CHECK(prepared.report.orientation == Orientation::inverted);
  CHECK(prepared.report.flipped_triangles == 10);
  CHECK(prepared.report.volume == Approx(1));
}

TEST_CASE("an inverted shell inside a body is a cavity and stays") {
  const TriangleMesh hollow = joined_meshes(box_mesh(Vec3d(-2), Vec3d(3)), inverted_mesh(box_mesh()));
  const PreparedMesh prepared = prepare_mesh(hollow);
  CHECK(prepared.report.flipped_triangles == 0);
  CHECK(prepared.report.orientation == Orientation::outward);
  CHECK(prepared.report.shells == 2);
  CHECK(prepared.report.volume == Approx(124));
  CHECK(winding_number(prepared.mesh, middle) == winding(0));
  CHECK(winding_number(prepared.mesh, Vec3d(-1)) == winding(1));
}

TEST_CASE("an inverted hollow body turns as a whole") {
  const PreparedMesh prepared =
      prepare_mesh(inverted_mesh(joined_meshes(box_mesh(Vec3d(-2), Vec3d(3)), inverted_mesh(box_mesh()))));
  CHECK(prepared.report.orientation == Orientation::inverted);
  CHECK(prepared.report.flipped_triangles == 24);
  CHECK(winding_number(prepared.mesh, middle) == winding(0));
  CHECK(winding_number(prepared.mesh, Vec3d(-1)) == winding(1));
}

TEST_CASE(
    "a body inside a cavity inside a body keeps its side, and is turned when it would wind below zero") {
  const TriangleMesh hollow =
      joined_meshes(box_mesh(Vec3d(-4), Vec3d(5)), inverted_mesh(box_mesh(Vec3d(-2), Vec3d(3))));
  for (const bool wrong : {false, true}) {
    const PreparedMesh prepared =
        prepare_mesh(joined_meshes(hollow, wrong ? inverted_mesh(box_mesh()) : box_mesh()));
    CHECK(prepared.report.flipped_triangles == (wrong ? 12 : 0));
    CHECK(winding_number(prepared.mesh, middle) == winding(1));
    CHECK(winding_number(prepared.mesh, Vec3d(-1)) == winding(0));
    CHECK(winding_number(prepared.mesh, Vec3d(-3)) == winding(1));
  }
}

TEST_CASE("of two separate bodies only the inverted one is turned") {
  const PreparedMesh prepared =
      prepare_mesh(joined_meshes(box_mesh(), inverted_mesh(box_mesh(Vec3d(3), Vec3d(4)))));
  CHECK(prepared.report.orientation == Orientation::mixed);
  CHECK(prepared.report.flipped_triangles == 12);
  CHECK(winding_number(prepared.mesh, middle) == winding(1));
  CHECK(winding_number(prepared.mesh, Vec3d(3.5)) == winding(1));
}

TEST_CASE("an inverted part that sticks out of a body is no cavity") {
  const PreparedMesh prepared = prepare_mesh(
      joined_meshes(box_mesh(Vec3d(0), Vec3d(4)), inverted_mesh(box_mesh(Vec3d(1, 1, 3), Vec3d(2, 2, 6)))));
  CHECK(prepared.report.flipped_triangles == 12);
  CHECK(winding_number(prepared.mesh, Vec3d(1.5, 1.4, 5)) == winding(1));
}

TEST_CASE("a Moebius strip is called non-orientable and left alone") {
  const PreparedMesh prepared = prepare_mesh(moebius_mesh(40));
  CHECK(prepared.report.orientation == Orientation::non_orientable);
  CHECK(prepared.report.winding_clashes == 1);
  CHECK(prepared.report.flipped_triangles == 0);
  CHECK(prepared.report.boundary_edges == 80);
  CHECK(prepared.report.boundary_loops == 1);
  CHECK(prepared.open_edges.size() == 82);
  CHECK(warned(prepared, "one-sided"));
}

TEST_CASE("three faces on an edge are reported, with the chain they leave") {
  const TriangleMesh fan{{{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {-1, 1, 0}, {-1, -1, 0}},
                         {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}};
  const PreparedMesh prepared = prepare_mesh(fan);
  CHECK(prepared.report.non_manifold_edges == 1);
  CHECK(prepared.report.non_manifold_vertices == 0);
  CHECK(prepared.report.boundary_edges == 6);
  CHECK(prepared.report.shells == 1);
  CHECK(prepared.open_edges.size() == 7);
}

TEST_CASE("two bodies that touch in a vertex are one component of two shells with one pinched vertex") {
  const PreparedMesh prepared = prepare_mesh(joined_meshes(box_mesh(), box_mesh(Vec3d(1), Vec3d(2))));
  CHECK(prepared.report.components == 1);
  CHECK(prepared.report.shells == 2);
  CHECK(prepared.report.non_manifold_vertices == 1);
  CHECK(prepared.report.non_manifold_edges == 0);
  CHECK(prepared.report.closed);
  CHECK(prepared.report.merged_vertices == 1);
}

TEST_CASE("bodies that share an edge pair up there, whichever of them is inverted") {
  const TriangleMesh a = box_mesh(), b = box_mesh(Vec3d(1, 1, 0), Vec3d(2, 2, 1));
  for (int mask = 0; mask < 4; ++mask) {
    const PreparedMesh prepared =
        prepare_mesh(joined_meshes(mask & 1 ? inverted_mesh(a) : a, mask & 2 ? inverted_mesh(b) : b));
    CAPTURE(mask);
    CHECK(prepared.report.non_manifold_edges == 1);
    CHECK(prepared.report.shells == 1);
    CHECK(prepared.open_edges.empty());
  }
}

TEST_CASE("a repeated face of a closed mesh is dropped") {
  TriangleMesh mesh = box_mesh();
  mesh.triangles.push_back({mesh.triangles[3][1], mesh.triangles[3][2], mesh.triangles[3][0]});
  const PreparedMesh prepared = prepare_mesh(mesh);
  CHECK(prepared.report.duplicate_triangles == 1);
  CHECK(prepared.report.opposite_triangles == 0);
  CHECK(prepared.mesh.triangles.size() == 12);
  CHECK(prepared.report.non_manifold_edges == 3);
  CHECK(prepared.open_edges.empty());
  CHECK(warned(prepared, "1 duplicate face dropped"));
}

TEST_CASE("a whole mesh that is there twice is dropped once") {
  const PreparedMesh prepared = prepare_mesh(joined_meshes(box_mesh(), box_mesh()));
  CHECK(prepared.report.duplicate_triangles == 12);
  CHECK(prepared.mesh.triangles.size() == 12);
  CHECK(prepared.open_edges.empty());
  CHECK(winding_number(prepared.mesh, middle) == winding(1));
}

TEST_CASE("a doubled face between two tetrahedra stays, and closes both however it is oriented") {
  TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.2, 0.2, 1}, {0.2, 0.2, -1}}, {}};
  mesh.triangles = {{0, 1, 3}, {1, 2, 3}, {2, 0, 3}, {1, 0, 4}, {2, 1, 4}, {0, 2, 4}};
  const Triangle up{0, 1, 2}, down{0, 2, 1};
  for (const auto& [first, second] : {std::pair{up, up}, std::pair{up, down}, std::pair{down, down}}) {
    TriangleMesh doubled = mesh;
    doubled.triangles.push_back(first);
    doubled.triangles.push_back(second);
    const PreparedMesh prepared = prepare_mesh(doubled);
    CHECK(prepared.report.duplicate_triangles == (first == second ? 1 : 0));
    CHECK(prepared.report.opposite_triangles == (first == second ? 0 : 1));
    CHECK(prepared.mesh.triangles.size() == 8);
    CHECK(prepared.open_edges.empty());
    CHECK(winding_number(prepared.mesh, Vec3d(0.2, 0.2, 0.3)) == winding(1));
    CHECK(winding_number(prepared.mesh, Vec3d(0.2, 0.2, -0.3)) == winding(1));
  }
}

TEST_CASE("an open sheet that is there twice is dropped once and stays open") {
  const TriangleMesh sheet = without_triangles(box_mesh(), 4, 8);
  const PreparedMesh prepared = prepare_mesh(joined_meshes(sheet, sheet));
  CHECK(prepared.report.duplicate_triangles == 4);
  CHECK(prepared.mesh.triangles.size() == 4);
  CHECK(prepared.open_edges.size() == 8);
}

TEST_CASE("of a double-sided mesh one side is kept and turned outward") {
  const PreparedMesh prepared = prepare_mesh(joined_meshes(inverted_mesh(box_mesh()), box_mesh()));
  CHECK(prepared.report.opposite_triangles == 12);
  CHECK(prepared.mesh.triangles.size() == 12);
  CHECK(prepared.open_edges.empty());
  CHECK(winding_number(prepared.mesh, middle) == winding(1));
  CHECK(warned(prepared, "12 faces are doubled"));

  const PreparedMesh trusted = prepare_mesh(joined_meshes(inverted_mesh(box_mesh()), box_mesh()), {true});
  CHECK(trusted.mesh.triangles.size() == 24);
}

TEST_CASE("an opposite pair on a closed body stays as geometry") {
  TriangleMesh mesh = box_mesh();
  mesh.vertices.push_back(Vec3d(2, 2, 2));
  mesh.triangles.push_back({0, 1, 8});
  mesh.triangles.push_back({1, 0, 8});
  const PreparedMesh prepared = prepare_mesh(mesh);
  CHECK(prepared.report.opposite_triangles == 1);
  CHECK(prepared.mesh.triangles.size() == 14);
  CHECK(prepared.open_edges.empty());
  CHECK(warned(prepared, "1 pair of opposite faces"));
}

TEST_CASE("a T-junction filled with a triangle without area stays closed") {
  TriangleMesh mesh = box_mesh();
  mesh.vertices.emplace_back(0.5, 0, 0); // on edge 0-1
  mesh.triangles[9] = {0, 3, 8};         // was 0 3 1
  mesh.triangles.push_back({8, 3, 1});
  const PreparedMesh open = prepare_mesh(mesh);
  CHECK(open.report.boundary_edges == 3);
  CHECK(open.report.degenerate_triangles == 0);

  mesh.triangles.push_back({0, 8, 1});
  const PreparedMesh closed = prepare_mesh(mesh);
  CHECK(closed.report.closed);
  CHECK(closed.open_edges.empty());
  CHECK(closed.report.degenerate_triangles == 1);
  CHECK(closed.mesh.triangles.size() == 14);
}

TEST_CASE("triangles with a repeated corner are dropped and counted") {
  TriangleMesh mesh = box_mesh();
  mesh.triangles.push_back({3, 3, 5});
  mesh.vertices.push_back(mesh.vertices[2]);
  mesh.triangles.push_back({2, 5, 8}); // repeated by position
  const PreparedMesh prepared = prepare_mesh(mesh);
  CHECK(prepared.mesh.triangles.size() == 12);
  CHECK(prepared.report.degenerate_triangles == 2);
  CHECK(prepared.report.closed);
}

TEST_CASE("meshes without triangles, without extent and without area are refused") {
  const auto message = [](const TriangleMesh& mesh) {
    try {
      prepare_mesh(mesh);
    } catch (const Error& e) {
      CHECK(e.kind() == ErrorKind::bad_input);
      return std::string(e.what());
    }
    return std::string();
  };
  CHECK(message({}).find("no triangles") == 0);
  CHECK(message({{{0, 0, 0}, {1, 0, 0}}, {}}).find("no triangles") == 0);
  CHECK(message({{{1, 2, 3}, {1, 2, 3}, {1, 2, 3}}, {{0, 1, 2}}}).find("mesh has no extent") == 0);
  CHECK(message({{{0, 0, 0}, {1, 0, 0}}, {{0, 1, 0}}}).find("no triangles with three") == 0);
  CHECK(message({{{0, 0, 0}, {1, 1, 1}, {3, 3, 3}}, {{0, 1, 2}}}).find("no triangles with an area") == 0);
}

TEST_CASE("a single flat triangle has no orientation but is accepted") {
  const PreparedMesh prepared = prepare_mesh({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}});
  CHECK(prepared.report.orientation == Orientation::undefined);
  CHECK(prepared.open_edges.size() == 3);
  CHECK(prepared.report.flipped_triangles == 0);
}

TEST_CASE("orientation is found far from the origin and at extreme scales") {
  for (const double offset : {1e7, -1e12})
    CHECK(prepare_mesh(inverted_mesh(moved_mesh(torus_mesh(24, 12, 2, 0.5), Vec3d(offset))))
              .report.flipped_triangles == 576);
  for (const double scale : {1e-30, 1e30})
    CHECK(prepare_mesh(inverted_mesh(moved_mesh(torus_mesh(24, 12, 2, 0.5), Vec3d(0), scale)))
              .report.flipped_triangles == 576);
}

TEST_CASE("a thousand inverted crumbs in the open and in a body are told apart") {
  TriangleMesh mesh = box_mesh(Vec3d(-1), Vec3d(41));
  for (int i = 0; i < 1000; ++i)
    mesh = joined_meshes(std::move(mesh),
                         inverted_mesh(box_mesh(Vec3d(i % 10, i / 10 % 10, i / 100) * 4.0 + Vec3d(0.5),
                                                Vec3d(i % 10, i / 10 % 10, i / 100) * 4.0 + Vec3d(1.5))));
  for (int i = 0; i < 10; ++i)
    mesh = joined_meshes(std::move(mesh),
                         inverted_mesh(box_mesh(Vec3d(100 + 2 * i, 0, 0), Vec3d(101 + 2 * i, 1, 1))));
  const PreparedMesh prepared = prepare_mesh(mesh);
  CHECK(prepared.report.shells == 1011);
  CHECK(prepared.report.flipped_triangles == 120);
  CHECK(prepared.report.volume == Approx(42.0 * 42 * 42 - 1000 + 10));
}

TEST_CASE("the prepared mesh does not depend on the number of threads") {
  TriangleMesh mesh = joined_meshes(torus_mesh(200, 100, 3, 1), inverted_mesh(torus_mesh(150, 70, 3, 0.4)));
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 97)
    std::swap(mesh.triangles[t][0], mesh.triangles[t][1]);
  PreparedMesh one, three;
  {
    const ThreadLimit limit(1);
    one = prepare_mesh(mesh);
  }
  {
    const ThreadLimit limit(3);
    three = prepare_mesh(mesh);
  }
  CHECK(one.mesh.triangles == three.mesh.triangles);
  CHECK(one.mesh.vertices == three.mesh.vertices);
  CHECK(one.open_edges.empty());
  CHECK(one.report.volume == three.report.volume);
  CHECK(one.report.shells == 2);
}
