// The bad inputs that users really hand over, row by row: each gives the right mesh or one line that says
// what is wrong, where, and what to do. Rows 18 to 29 are in mesh_reader_matrix_counts.cpp, those of them
// that load (23, 25, 28) in mesh_reader_formats.cpp.
#include "support/mesh_texts.hpp"

#include <filesystem>
#include <fstream>
#include <sys/stat.h>
#include <unistd.h>

using namespace levelray;
using namespace levelray::test;
using Catch::Matchers::Contains;
using Catch::Matchers::Equals;
using Catch::Matchers::StartsWith;

namespace {

class Folder {
 public:
  Folder()
      : path_(std::filesystem::temp_directory_path() / fmt::format("levelray_mesh_reader_{}", ::getpid())) {
    std::filesystem::create_directories(path_);
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  std::string operator/(const std::string& name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

void write(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

std::string read_refusal(const std::string& path, const MeshReadOptions& options = {},
                         ErrorKind kind = ErrorKind::bad_input) {
  try {
    read_mesh(path, options);
    FAIL("read " << path);
  } catch (const Error& error) {
    CHECK(error.kind() == kind);
    return error.what();
  }
  return "";
}

const std::string three_vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

} // namespace

TEST_CASE("row 1: a missing file is named") {
  const Folder folder;
  CHECK_THAT(read_refusal(folder / "x.obj"), Equals((folder / "x.obj") + ": no such file"));
  CHECK_THAT(read_refusal(""), Contains("no file name"));
}

TEST_CASE("row 2: folders and FIFOs are refused without waiting") {
  const Folder folder;
  std::filesystem::create_directory(folder / "d.obj");
  CHECK_THAT(read_refusal(folder / "d.obj"), Contains("d.obj: is a directory"));
  REQUIRE(::mkfifo((folder / "f.obj").c_str(), 0600) == 0);
  CHECK_THAT(read_refusal(folder / "f.obj"), Contains("f.obj: is a FIFO; ") && Contains("--format"));
  CHECK_THAT(read_refusal("/dev/null", {"obj"}), Contains("/dev/null: is not a regular file"));
}

TEST_CASE("an unreadable file is refused") {
  if (::geteuid() == 0) {
    WARN("not tested: root may read everything");
    return;
  }
  const Folder folder;
  write(folder / "x.obj", three_vertices);
  REQUIRE(::chmod((folder / "x.obj").c_str(), 0) == 0);
  CHECK_THAT(read_refusal(folder / "x.obj"), Contains("x.obj: no permission"));
}

TEST_CASE("row 3: an empty file is called empty") {
  const Folder folder;
  for (const std::string& format : mesh_format_names()) {
    const std::string name = fmt::format("x.{}", format);
    write(folder / name, "");
    CHECK_THAT(read_refusal(folder / name), Contains(name + ": empty file"));
    CHECK(refusal("", name) == name + ": empty file");
  }
}

TEST_CASE("row 4: text that is no mesh is called so") {
  const std::string text = "Dear reader,\nthis file says nothing about triangles.\n";
  CHECK(refusal(text, "x.obj") == "x.obj: no vertices or faces found; is this OBJ?");
  CHECK(refusal(text, "x.off") == "x.off: no vertices or faces found; is this OFF?");
  CHECK(refusal(text + std::string(100, '-'), "x.stl") == "x.stl: no vertices or faces found; is this STL?");
  CHECK_THAT(refusal(text, "x.ply"), Equals("x.ply: does not start with \"ply\"; is this PLY?"));
}

TEST_CASE("row 5: content that is unmistakably another format is named") {
  CHECK(refusal(ply_text(box()), "x.obj") == "x.obj: content looks like PLY, not OBJ; use --format ply");
  CHECK(refusal(ply_binary(box(), true), "x.stl") ==
        "x.stl: content looks like PLY, not STL; use --format ply");
  CHECK_THAT(refusal(off_text(box()), "x.obj"), Contains("content looks like OFF"));
  CHECK_THAT(refusal(stl_text(box()), "x.off"), Contains("content looks like STL"));
  CHECK_THAT(refusal(stl_text(box()), "x.stl", {"ply"}), Contains("use --format stl"));
  // Without a name that says otherwise, the content is enough.
  CHECK(parsed(ply_binary(box(), false), "mesh").format == "ply");
  CHECK(parsed(off_text(box()), "mesh.txt").format == "off");
  CHECK(parsed(stl_text(box()), "mesh.dat").format == "stl");
  CHECK(parsed(obj_text(box()), "mesh.txt", {"obj"}).format == "obj");
}

TEST_CASE("row 6: unknown extensions, formats and foreign files are refused with the legal ones") {
  CHECK(refusal("{\"asset\": {}}", "x.gltf", {}, ErrorKind::usage) ==
        "x.gltf: .gltf not supported; supported: obj, ply, stl, off (--format names one)");
  CHECK_THAT(refusal("v 0 0 0", "x", {}, ErrorKind::usage), Contains("supported: obj, ply, stl, off"));
  CHECK_THAT(refusal("v 0 0 0", "x.obj", {"gltf"}, ErrorKind::usage),
             Contains("unknown mesh format \"gltf\"; supported: obj, ply, stl, off"));
  CHECK_THAT(refusal(std::string("\x1F\x8B\x08\0\0", 5), "x.obj.gz"),
             Contains("gzip-compressed; gunzip it first"));
  CHECK_THAT(refusal("version https://git-lfs.github.com/spec/v1\n", "x.ply"), Contains("git-LFS pointer"));
  CHECK_THAT(refusal("<!DOCTYPE html>\n", "x.obj"), Contains("web page"));
  CHECK_THAT(refusal(std::string("glTF\2\0\0\0", 8), "x.glb"), Contains("glTF"));
}

TEST_CASE("row 7: points without faces are counted") {
  std::string points;
  for (int i = 0; i < 12; ++i) points += fmt::format("v {} 0 1\n", i);
  CHECK_THAT(refusal(points, "x.obj"), StartsWith("x.obj: 12 vertices, no faces; "));
  CHECK(refusal(points + "p 1 2\n", "x.obj") ==
        "x.obj: 12 vertices, no faces; line and point elements make no surface to convert");
  CHECK_THAT(refusal(points + "cstype bezier\n", "x.obj"), Contains("free-form curves and surfaces"));
  CHECK_THAT(refusal(ply_text({tetrahedron().vertices, {}}), "x.ply"),
             StartsWith("x.ply: 4 vertices, no faces; "));
  CHECK_THAT(refusal(off_text({tetrahedron().vertices, {}}), "x.off"),
             StartsWith("x.off: 4 vertices, no faces; "));
}

TEST_CASE("row 8: a bad number is quoted with its line") {
  CHECK(refusal("v 0,5 0 0\n", "x.obj") == "x.obj:1: bad number \"0,5\" (decimal comma?)");
  CHECK(refusal("v 0 0 0\n\nv 1 x 0\n", "x.obj") == "x.obj:3: bad number \"x\"");
  CHECK(refusal("v 0 0 0\r\nv 1 1e 0\r\n", "x.obj") == "x.obj:2: bad number \"1e\"");
  CHECK(refusal("v 0 0 0\rv 1 2 0x1\r", "x.obj") == "x.obj:2: bad number \"0x1\"");
  CHECK_THAT(refusal("v 0 0 0 v 1 0 0\n", "x.obj"), StartsWith("x.obj:1: bad number \"v\""));
  CHECK_THAT(refusal("v 0 0\nf 1 2 3\n", "x.obj"), StartsWith("x.obj:1: incomplete vertex"));
  CHECK(refusal("OFF\n3 1 0\n0 0 0\n1,5 0 0\n0 1 0\n3 0 1 2\n", "x.off") ==
        "x.off:4: bad number \"1,5\" (decimal comma?)");
  CHECK(refusal(ply_header("ascii", 3, 1) + "0 0 0\n1 0 0,5\n0 1 0\n3 0 1 2\n", "x.ply") ==
        "x.ply:11: bad number \"0,5\" (decimal comma?)");
  CHECK(refusal("solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 a\n", "x.stl", {"stl"}) ==
        "x.stl:4: bad number \"a\"");
}

TEST_CASE("row 9: non-finite coordinates are refused, or their faces dropped and no index shifted") {
  for (const char* bad : {"nan", "inf", "-inf", "1e400", "-1e999999999999", "NaN", "infinity", "-nan(ind)",
                          "1.#INF", "-1.#IND"}) {
    CAPTURE(bad);
    const std::string text = fmt::format("v 0 0 {}\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 2 3 4\n", bad);
    CHECK_THAT(refusal(text, "x.obj"),
               StartsWith("x.obj:1: non-finite coordinate") && Contains("--drop-bad"));
    MeshReadOptions drop;
    drop.drop_bad = true;
    const MeshFile file = parsed(text, "x.obj", drop);
    REQUIRE(is_sound(file.mesh));
    REQUIRE(file.mesh.triangles.size() == 1);
    CHECK(file.mesh.vertices[file.mesh.triangles[0][1]] == Vec3d(1, 0, 0));
    CHECK(file.mesh.vertices[file.mesh.triangles[0][2]] == Vec3d(0, 1, 0));
    REQUIRE(file.warnings.size() == 2);
    CHECK(file.warnings[0] == "x.obj:1: 1 vertex with a non-finite coordinate dropped");
    CHECK(file.warnings[1] == "x.obj:5: 1 face with a non-finite corner dropped");
  }
  PolygonMesh infinite = tetrahedron();
  infinite.vertices[2].y = INFINITY;
  const std::string ply = ply_binary(infinite, false);
  CHECK_THAT(refusal(ply, "x.ply"),
             StartsWith(fmt::format("x.ply@{}: non-finite coordinate", ply.find("end_header\n") + 11 + 24)));
  CHECK_THAT(refusal(stl_binary(infinite), "x.stl"), StartsWith("x.stl@84: non-finite coordinate"));
}

TEST_CASE("row 10: vertex indices that the file does not have are named with their line") {
  CHECK_THAT(refusal(three_vertices + "f 1 2 9\n", "x.obj"),
             StartsWith("x.obj:4: vertex index 9, file has 3"));
  CHECK(refusal(three_vertices + "f 0 1 2\n", "x.obj") == "x.obj:4: vertex index 0; OBJ counts from 1");
  CHECK_THAT(refusal(three_vertices + "f 1 2 3000000000\n", "x.obj"),
             StartsWith("x.obj:4: vertex index 3000000000, file has 3"));
  CHECK_THAT(refusal(three_vertices + "f 1 2 99999999999999999999\n", "x.obj"),
             StartsWith("x.obj:4: vertex index 9223372036854775807, file has 3"));
  CHECK_THAT(refusal(three_vertices + "f -1 -2 -4\n", "x.obj"),
             StartsWith("x.obj:4: vertex index -4, file has 3"));
  CHECK_THAT(refusal(three_vertices + "f 1 2 -9223372036854775808\n", "x.obj"),
             StartsWith("x.obj:4: vertex index -"));
  CHECK_THAT(refusal(off_text({tetrahedron().vertices, {{0, 1, 4}}}), "x.off"),
             StartsWith("x.off:7: vertex index 4, file has 4"));
  CHECK_THAT(refusal(ply_text({tetrahedron().vertices, {{0, 1, 2}, {0, 1, 7}}}), "x.ply"),
             StartsWith("x.ply:15: vertex index 7, file has 4"));
  CHECK_THAT(refusal(ply_header("ascii", 3, 1) + "0 0 0\n1 0 0\n0 1 0\n3 0 1 -2\n", "x.ply"),
             StartsWith("x.ply:13: vertex index -2, file has 3"));
  // A face may come before its vertices.
  CHECK(parsed("f 1 2 3\n" + three_vertices, "x.obj").mesh.triangles.size() == 1);
}

TEST_CASE("row 11: faces with fewer than three corners are skipped and counted") {
  const MeshFile file = parsed(three_vertices + "f 1 2 3\nf 1 2\nf 3\n", "x.obj");
  CHECK(file.mesh.triangles.size() == 1);
  REQUIRE(file.warnings.size() == 1);
  CHECK(file.warnings[0] == "x.obj:5: 2 faces with fewer than three corners skipped, the first one here");
}

TEST_CASE("row 12: faces that repeat a vertex are left out, those without area are counted") {
  const MeshFile repeated = parsed(three_vertices + "f 1 2 3\nf 1 2 1\nf 2 2 3\nf 1 2 2 3\n", "x.obj");
  CHECK(repeated.mesh.triangles == std::vector<Triangle>{{0, 1, 2}, {0, 1, 2}});
  REQUIRE(repeated.warnings.size() == 1);
  CHECK_THAT(repeated.warnings[0], StartsWith("x.obj:5: 3 faces repeat a vertex"));

  const MeshFile flat = parsed("v 0 0 0\nv .1 .1 .1\nv .3 .3 .3\nv 1 0 0\nf 1 2 3\nf 1 3 4\n", "x.obj");
  CHECK(flat.mesh.triangles.size() == 2); // kept: distances to it are right
  REQUIRE(flat.warnings.size() == 1);
  CHECK_THAT(flat.warnings[0], StartsWith("x.obj: 1 triangle is without area"));
  CHECK_THAT(refusal(three_vertices + "f 1 1 2\n", "x.obj"), Contains("no face has three different corners"));
}

TEST_CASE("row 13: a concave polygon loads without a word") {
  // An arrow head: the first corner's fan would cover what is outside.
  const MeshFile file = parsed("v 2 0 0\nv 0 2 0\nv 0.5 0 0\nv 0 -2 0\nf 2 3 4 1\n", "x.obj");
  CHECK(file.warnings.empty());
  REQUIRE(file.mesh.triangles.size() == 2);
  CHECK(surface_area(file.mesh) ==
        Approx(3.0).epsilon(1e-15)); // 2 * (2 * 1.5 / 2), exact but for one rounding
}

TEST_CASE("row 14: a quad that is not planar loads and its deviation is told") {
  // Corners alternately 0.1 above and below the plane z = 0.
  const MeshFile file = parsed("v 0 0 .1\nv 1 0 -.1\nv 1 1 .1\nv 0 1 -.1\nf 1 2 3 4\n", "x.obj");
  CHECK(file.mesh.triangles.size() == 2);
  REQUIRE(file.warnings.size() == 1);
  CHECK(file.warnings[0] == "x.obj:5: 1 polygon is not planar, the most here: a corner is 0.1 off its plane");
  // Coordinates that six digits rounded do not count as bent.
  CHECK(parsed("v 0 0 0\nv 1 0 0.333333\nv 1 1 1\nv 0 1 0.666667\nf 1 2 3 4\n", "x.obj").warnings.empty());
}

TEST_CASE("row 15: line continuations, CR LF, CR alone, byte order marks and tabs load") {
  const std::string text = obj_text(box());
  const MeshFile plain = parsed(text, "x.obj");
  const auto replaced = [&](const std::string& from, const std::string& to) {
    std::string out;
    for (const char c : text) out += std::string(1, c) == from ? to : std::string(1, c);
    return out;
  };
  for (const std::string& variant :
       {replaced("\n", "\r\n"), replaced("\n", "\r"), replaced(" ", "\t"), replaced(" ", " \\\n "),
        replaced(" ", " \\\r\n"), replaced(" ", "\\\r"), "\xEF\xBB\xBF" + text, replaced("\n", " \n\n")}) {
    const MeshFile file = parsed(variant, "x.obj");
    CHECK(file.mesh.vertices == plain.mesh.vertices);
    CHECK(file.mesh.triangles == plain.mesh.triangles);
    CHECK(file.warnings.empty());
  }
  CHECK_THAT(refusal(std::string("\xFF\xFEv\0 \0", 6), "x.obj"),
             StartsWith("x.obj:1: is UTF-16 text; convert"));
  CHECK_THAT(refusal(std::string("\0v\0 \0000\0 \0000\0 \0000\0\n", 16), "x.obj"), Contains("UTF-16"));
}

TEST_CASE("row 16: a last line that was cut is an error") {
  const std::string text = three_vertices + "f 1 2 3\nf 2 3 1\n";
  CHECK_THAT(refusal(text + "f 1 2", "x.obj"), StartsWith("x.obj:6: incomplete face"));
  CHECK_THAT(refusal(text + "f", "x.obj"), StartsWith("x.obj:6: incomplete face"));
  CHECK_THAT(refusal(text + "f 1/1 2/2 3/", "x.obj"), StartsWith("x.obj:6: incomplete face"));
  CHECK_THAT(refusal(text + "v 1 2", "x.obj"), StartsWith("x.obj:6: incomplete vertex"));
  MeshReadOptions salvage;
  salvage.salvage = true;
  const MeshFile file = parsed(text + "f 1 2", "x.obj", salvage);
  CHECK(file.mesh.triangles.size() == 2);
  REQUIRE(file.warnings.size() == 1);
  CHECK_THAT(file.warnings[0], StartsWith("x.obj:6: incomplete face"));
}

TEST_CASE("row 17: free-form geometry is ignored with a warning") {
  const MeshFile file =
      parsed(three_vertices + "cstype bezier\ndeg 3\ncurv 0 1 1 2 \\\n 3\nend\nf 1 2 3\n", "x.obj");
  CHECK(file.mesh.triangles.size() == 1);
  REQUIRE(file.warnings.size() == 1);
  CHECK_THAT(file.warnings[0], StartsWith("x.obj:4: 4 free-form statements ignored"));
}

TEST_CASE("standard input is read when its format is given") {
  int ends[2];
  REQUIRE(::pipe(ends) == 0);
  const std::string text = obj_text(box());
  REQUIRE(::write(ends[1], text.data(), text.size()) == static_cast<ssize_t>(text.size()));
  ::close(ends[1]);
  const int saved = ::dup(0);
  ::dup2(ends[0], 0);
  CHECK_THAT(read_refusal("-", {}, ErrorKind::usage), Contains("standard input needs --format"));
  CHECK(read_mesh("-", {"obj"}).mesh.triangles.size() == 12);
  CHECK_THAT(read_refusal("-", {"obj"}), Contains("standard input: empty"));
  ::dup2(saved, 0);
  ::close(saved);
  ::close(ends[0]);
}

TEST_CASE("messages about long and strange names stay one line of at most 500 bytes") {
  for (const std::string& name :
       {std::string(4000, 'a') + ".obj", std::string("a\nb\x1B[31m\xFF") + ".obj"}) {
    const std::string text = refusal("v " + std::string(3000, 'x') + " 0 0\n", name);
    CHECK(text.size() <= 500);
    CHECK_THAT(text, Contains(".obj:1: bad number \"xxx"));
    for (const char c : text) CHECK(!(static_cast<unsigned char>(c) < 0x20));
  }
}
