// OpenMesh as a second opinion on manifold meshes, which are all that its half-edges can hold.
#include "levelray/io/mesh_reader.hpp"
#include "levelray/measure/made_meshes.hpp"
#include "levelray/mesh/prepare.hpp"
#include "support/catch.hpp"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wshadow"
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Core/System/omstream.hh>
#pragma GCC diagnostic pop

#include <filesystem>

using namespace levelray;

namespace {

struct Counts {
  std::uint64_t refused = 0, boundary_edges = 0, boundary_loops = 0, components = 0;
  std::int64_t euler = 0;
};

Counts by_openmesh(const TriangleMesh& mesh) {
  omerr().disable(); // it prints a line for each face that it refuses; we count them
  OpenMesh::TriMesh_ArrayKernelT<> half_edges;
  Counts out;
  std::vector<OpenMesh::VertexHandle> vertices;
  for (const Vec3d& v : mesh.vertices)
    vertices.push_back(
        half_edges.add_vertex({static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)}));
  for (const Triangle& t : mesh.triangles)
    out.refused += !half_edges.add_face(vertices[t[0]], vertices[t[1]], vertices[t[2]]).is_valid();

  std::vector<bool> seen(half_edges.n_halfedges(), false);
  for (const auto start : half_edges.halfedges()) {
    if (!half_edges.is_boundary(start)) continue;
    ++out.boundary_edges;
    if (seen[static_cast<std::size_t>(start.idx())]) continue;
    ++out.boundary_loops;
    auto h = OpenMesh::HalfedgeHandle(start);
    do {
      seen[static_cast<std::size_t>(h.idx())] = true;
      h = half_edges.next_halfedge_handle(h);
    } while (h != start);
  }
  std::vector<bool> reached(half_edges.n_vertices(), false);
  for (const auto seed : half_edges.vertices()) {
    if (reached[static_cast<std::size_t>(seed.idx())]) continue;
    ++out.components;
    std::vector<OpenMesh::VertexHandle> stack{seed};
    reached[static_cast<std::size_t>(seed.idx())] = true;
    while (!stack.empty()) {
      const OpenMesh::VertexHandle v = stack.back();
      stack.pop_back();
      for (auto next = half_edges.vv_iter(v); next.is_valid(); ++next) {
        if (reached[static_cast<std::size_t>(next->idx())]) continue;
        reached[static_cast<std::size_t>(next->idx())] = true;
        stack.push_back(*next);
      }
    }
  }
  out.euler = static_cast<std::int64_t>(half_edges.n_vertices()) -
              static_cast<std::int64_t>(half_edges.n_edges()) +
              static_cast<std::int64_t>(half_edges.n_faces());
  return out;
}

// Edges counted from ours: every edge has two triangles or one.
void compare(const std::string& name, const PreparedMesh& mesh) {
  INFO(name);
  const MeshReport& r = mesh.report;
  const Counts theirs = by_openmesh(mesh.mesh);
  CHECK(theirs.refused == 0);
  CHECK(theirs.boundary_edges == r.boundary_edges);
  CHECK(theirs.boundary_loops == r.boundary_loops);
  CHECK(theirs.components == r.components);
  const std::uint64_t edges = (3 * mesh.mesh.triangles.size() + r.boundary_edges) / 2;
  CHECK(theirs.euler == static_cast<std::int64_t>(mesh.mesh.vertices.size()) -
                            static_cast<std::int64_t>(edges) +
                            static_cast<std::int64_t>(mesh.mesh.triangles.size()));
}

} // namespace

TEST_CASE("OpenMesh finds the same boundaries, components and Euler characteristic on made meshes") {
  compare("tetrahedron", prepare_mesh(tetrahedron_mesh()));
  compare("torus", prepare_mesh(torus_mesh(20, 11, 2, 1)));
  compare("open box", prepare_mesh(without_triangles(box_mesh(), 0, 2)));
  compare("tube", prepare_mesh(without_triangles(box_mesh(), 0, 4)));
  compare("two", prepare_mesh(joined_meshes(box_mesh(), torus_mesh(20, 11, 9, 1))));
  TriangleMesh flipped = torus_mesh(20, 11, 2, 1);
  for (std::size_t t = 0; t < flipped.triangles.size(); t += 3)
    std::swap(flipped.triangles[t][0], flipped.triangles[t][1]);
  CHECK(by_openmesh(flipped).refused > 0); // clashing faces do not fit into half-edges
  compare("repaired", prepare_mesh(flipped));
}

TEST_CASE("OpenMesh finds the same boundaries, components and Euler characteristic on real manifold meshes") {
  const std::filesystem::path testdata = LEVELRAY_TESTDATA;
  if (!std::filesystem::exists(testdata / "classic")) {
    WARN("no test data at " << testdata << ": nothing checked");
    return;
  }
  int compared = 0;
  for (const char* folder : {"classic", "hard"})
    for (const auto& entry : std::filesystem::directory_iterator(testdata / folder)) {
      if (entry.path().extension() == ".gz" || entry.file_size() > 6000000) continue;
      const PreparedMesh mesh = prepare_mesh(read_mesh(entry.path().string()).mesh);
      const MeshReport& r = mesh.report;
      if (r.non_manifold_edges + r.non_manifold_vertices > 0 || r.orientation == Orientation::non_orientable)
        continue;
      compare(entry.path().filename().string(), mesh);
      ++compared;
    }
  CHECK(compared >= 25);
}
