// OpenMesh's readers as a second opinion on files that are right. They are no reference: they lose faces of
// many legal files silently and read coordinates as float, so only files that they are known to read are
// compared.
#include "support/mesh_texts.hpp"

#include <OpenMesh/Core/IO/IOManager.hh>
#include <OpenMesh/Core/IO/importer/BaseImporter.hh>
#include <OpenMesh/Core/Mesh/BaseKernel.hh>
#include <filesystem>

namespace {

using namespace OpenMesh; // for the signatures below

// Collects what OpenMesh's readers deliver, before its half-edge structure could refuse any of it.
class SoupImporter : public IO::BaseImporter {
 public:
  VertexHandle add_vertex(const OpenMesh::Vec3f& p) override {
    positions.push_back(p);
    return VertexHandle(static_cast<int>(positions.size()) - 1);
  }
  VertexHandle add_vertex() override { return add_vertex(OpenMesh::Vec3f(0, 0, 0)); }
  void set_point(VertexHandle vertex, const OpenMesh::Vec3f& p) override {
    positions[static_cast<std::size_t>(vertex.idx())] = p;
  }
  FaceHandle add_face(const VHandles& corners) override {
    triangles += corners.size() < 3 ? 0 : corners.size() - 2;
    return FaceHandle(static_cast<int>(faces++));
  }
  size_t n_vertices() const override { return positions.size(); }
  size_t n_faces() const override { return faces; }
  size_t n_edges() const override { return 0; }

  std::vector<OpenMesh::Vec3f> positions;
  std::size_t faces = 0, triangles = 0;

  // Everything else a reader may deliver is let go.
  HalfedgeHandle add_edge(VertexHandle, VertexHandle) override { return HalfedgeHandle(); }
  FaceHandle add_face(HalfedgeHandle) override { return FaceHandle(); }
  void add_face_texcoords(FaceHandle, VertexHandle, const std::vector<Vec2f>&) override {}
  void add_face_texcoords(FaceHandle, VertexHandle, const std::vector<OpenMesh::Vec3f>&) override {}
  void set_face_texindex(FaceHandle, int) override {}
  void set_halfedge(VertexHandle, HalfedgeHandle) override {}
  void set_normal(VertexHandle, const OpenMesh::Vec3f&) override {}
  void set_normal(VertexHandle, const OpenMesh::Vec3d&) override {}
  void set_color(VertexHandle, const Vec3uc&) override {}
  void set_color(VertexHandle, const Vec4uc&) override {}
  void set_color(VertexHandle, const OpenMesh::Vec3f&) override {}
  void set_color(VertexHandle, const Vec4f&) override {}
  void set_texcoord(VertexHandle, const Vec2f&) override {}
  void set_status(VertexHandle, const Attributes::StatusInfo&) override {}
  void set_next(HalfedgeHandle, HalfedgeHandle) override {}
  void set_face(HalfedgeHandle, FaceHandle) override {}
  void request_face_texcoords2D() override {}
  void set_texcoord(HalfedgeHandle, const Vec2f&) override {}
  void set_texcoord(VertexHandle, const OpenMesh::Vec3f&) override {}
  void set_texcoord(HalfedgeHandle, const OpenMesh::Vec3f&) override {}
  void set_status(HalfedgeHandle, const Attributes::StatusInfo&) override {}
  void set_color(EdgeHandle, const Vec3uc&) override {}
  void set_color(EdgeHandle, const Vec4uc&) override {}
  void set_color(EdgeHandle, const OpenMesh::Vec3f&) override {}
  void set_color(EdgeHandle, const Vec4f&) override {}
  void set_status(EdgeHandle, const Attributes::StatusInfo&) override {}
  void set_normal(FaceHandle, const OpenMesh::Vec3f&) override {}
  void set_normal(FaceHandle, const OpenMesh::Vec3d&) override {}
  void set_color(FaceHandle, const Vec3uc&) override {}
  void set_color(FaceHandle, const Vec4uc&) override {}
  void set_color(FaceHandle, const OpenMesh::Vec3f&) override {}
  void set_color(FaceHandle, const Vec4f&) override {}
  void set_status(FaceHandle, const Attributes::StatusInfo&) override {}
  void add_texture_information(int, std::string) override {}
};

} // namespace

using namespace levelray::test;
using levelray::MeshFile;
using levelray::read_mesh;

TEST_CASE("OpenMesh's readers and ours find the same vertices and faces in valid files") {
  const std::filesystem::path testdata = LEVELRAY_TESTDATA;
  if (!std::filesystem::is_directory(testdata)) {
    WARN("not tested: no test data at " << testdata.string());
    return;
  }
  for (const char* name :
       {"classic/stanford-bunny.obj", "classic/armadillo-86k.obj", "classic/spot.obj", "classic/teapot.obj",
        "classic/suzanne.obj", "classic/cow.obj", "classic/dragon_vrip_res3.ply",
        "classic/statue-of-liberty-20k.ply", "hard/gc-moebius.obj", "hard/trimesh-quadknot.obj",
        "hard/c3tm-beast.obj", "hard/trimesh-cycloidal.ply", "hard/opencv-bunny.ply", "hard/cgal-bones.off",
        "hard/cgal-boeing.off", "hard/cgal-elephant-with-holes.off",
        "sequence/flag_remeshed_ply/flag_0008.ply"}) {
    CAPTURE(name);
    const std::string path = (testdata / name).string();
    const MeshFile ours = read_mesh(path);
    SoupImporter theirs;
    OpenMesh::IO::Options options;
    REQUIRE(OpenMesh::IO::IOManager().read(path, theirs, options));
    CHECK(ours.mesh.triangles.size() == theirs.triangles);
    REQUIRE(ours.mesh.vertices.size() == theirs.positions.size());
    // Theirs are rounded to float, once: within 2^-24 of the value (and of float's smallest normal number).
    double worst = 0;
    for (std::size_t i = 0; i < theirs.positions.size(); ++i)
      for (int k = 0; k < 3; ++k) {
        const double x = ours.mesh.vertices[i][k];
        const double y = static_cast<double>(theirs.positions[i][static_cast<std::size_t>(k)]);
        worst = std::max(worst, std::abs(x - y) / std::max(std::abs(x), 0x1p-126));
      }
    CHECK(worst <= 0x1p-23); // twice: their own conversion from decimal is not always correctly rounded
  }
}
