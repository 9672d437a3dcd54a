// Right meshes from every legal spelling of the four formats.
#include "support/mesh_texts.hpp"

#include "levelray/core/parallel.hpp"

#include <clocale>
#include <sys/wait.h>
#include <unistd.h>

using namespace levelray;
using namespace levelray::test;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;

namespace {

void check_box(const MeshFile& file, const std::string& format) {
  CHECK(file.format == format);
  CHECK(is_sound(file.mesh));
  CHECK(file.mesh.triangles.size() == 12);
  // All coordinates are multiples of 1/8: every product and sum is exact.
  CHECK(signed_volume(file.mesh) == 1.0);
  CHECK(surface_area(file.mesh) == 6.0);
  CHECK(file.mesh.bounds().min == Vec3d(1.5, -2.25, 10.125));
  for (const std::string& warning : file.warnings) FAIL_CHECK(warning);
}

} // namespace

TEST_CASE("every format gives the same box") {
  check_box(parsed(obj_text(box()), "x.obj"), "obj");
  check_box(parsed(off_text(box()), "x.off"), "off");
  check_box(parsed(ply_text(box()), "x.ply"), "ply");
  check_box(parsed(ply_binary(box(), false), "x.PLY"), "ply");
  check_box(parsed(ply_binary(box(), true), "x.ply"), "ply");
  check_box(parsed(stl_text(box()), "x.stl"), "stl");
  check_box(parsed(stl_binary(box()), "x.STL"), "stl");
}

TEST_CASE("texts without a last line end are whole") {
  for (const std::string& format : mesh_format_names()) {
    std::string text = format == "obj"   ? obj_text(box())
                       : format == "off" ? off_text(box())
                       : format == "ply" ? ply_text(box())
                                         : stl_text(box());
    text.pop_back();
    check_box(parsed(text, fmt::format("x.{}", format)), format);
  }
}

TEST_CASE("coordinates keep all digits of a double in every format that holds them") {
  PolygonMesh mesh = tetrahedron();
  mesh.vertices[1] = {1234567.123456789, -0.1, 1e-310};
  mesh.vertices[2] = {-1e15 / 3, 5e-324, 1.7976931348623157e308};
  CHECK(parsed(obj_text(mesh), "x.obj").mesh.vertices == mesh.vertices);
  CHECK(parsed(off_text(mesh), "x.off").mesh.vertices == mesh.vertices);
  CHECK(parsed(ply_text(mesh), "x.ply").mesh.vertices == mesh.vertices);
  for (const bool big : {false, true}) {
    std::string bytes = ply_header(big ? "binary_big_endian" : "binary_little_endian", 4, 1, "double");
    for (const Vec3d& v : mesh.vertices)
      for (const double x : {v.x, v.y, v.z}) bytes += bytes_of(x, big);
    bytes += '\3';
    for (const int v : {0, 1, 2}) bytes += bytes_of(v, big);
    CHECK(parsed(bytes, "x.ply").mesh.vertices == mesh.vertices);
  }
}

TEST_CASE("a minus zero becomes a zero") {
  const MeshFile file = parsed("v -0 -0.0 -1e-999\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "x.obj");
  for (const double x : {file.mesh.vertices[0].x, file.mesh.vertices[0].y, file.mesh.vertices[0].z}) {
    CHECK(x == 0);
    CHECK(!std::signbit(x));
  }
}

TEST_CASE("OBJ faces may name textures and normals, count back, and stand among anything else") {
  const std::string text =
      "# a square pyramid\nmtllib a b\\\no base\ng one two\ns off\nusemtl c:\\paint\\\n"
      "v .5 -.5 0 1.0\nvt 0 0\nvn 0 0 1\nv -.5 -5.e-1 +0 0.3 0.4 0.5\nv -0.5 0.5 0 nan nan nan\n"
      "\tv 0.5 0.5 0 1 2 3 4 # colour\nv 0 0 -1\n"
      "f 1/1/1 4/1/1 3/1/1 2/1/1# floor\nf 1// 2// 5//\n  f 2/ 3/ 5/\nf -3//1 -2//1 -1//1\n"
      "l 1 2 3\np 1\nf 4/-1/-1 1/-1/-1 \\\n 5/-1/-1\n";
  const MeshFile file = parsed(text, "x.obj");
  CHECK(file.mesh.vertices.size() == 5);
  CHECK(file.mesh.triangles.size() == 6);
  CHECK(signed_volume(file.mesh) == Approx(1.0 / 3));
  REQUIRE(file.warnings.size() == 1);
  CHECK_THAT(file.warnings[0], StartsWith("x.obj:18: 2 line and point elements ignored"));
  CHECK_THAT(parsed(obj_text(box()) + "blob 1 2 3\n", "x.obj").warnings.at(0),
             StartsWith("x.obj:15: 1 line with an unknown keyword ignored"));
}

TEST_CASE("malformed OBJ face corners are refused with their line") {
  for (const char* corner : {"1.0", "1/x", "1/2/3/4", "1//2/", "/1", "1-", "--1", "a", "1,2"}) {
    CAPTURE(corner);
    const std::string text = refusal(fmt::format("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 2 3 {}\n", corner), "x.obj");
    CHECK_THAT(text, StartsWith(fmt::format("x.obj:4: bad face corner \"{}\"", corner)));
  }
  CHECK_THAT(refusal(obj_text(box()) + std::string("\0\0\0", 3), "x.obj"),
             StartsWith("x.obj:15: unexpected byte 0x00"));
}

TEST_CASE("row 23: PLY strips alternate, end at negative indices and drop their stitches") {
  std::string text =
      "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\n"
      "element tristrips 2\nproperty list int int vertex_indices\nend_header\n"
      "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n9 0 1 2 3 -1 2 3 3 4\n4 0 1 2 3\n";
  const MeshFile file = parsed(text, "x.ply");
  CHECK(file.mesh.triangles == std::vector<Triangle>{{0, 1, 2}, {2, 1, 3}, {0, 1, 2}, {2, 1, 3}});
  CHECK(signed_volume(file.mesh) == 0);
  text.replace(text.find("9 0 1 2 3 -1"), 12, "9 0 1 2 5 -1");
  CHECK_THAT(refusal(text, "x.ply"), StartsWith("x.ply:15: vertex index 5 of a strip, file has 5"));
}

TEST_CASE("PLY text keeps to its lines") {
  const std::string head = ply_header("ascii", 3, 1);
  CHECK(parsed(head + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", "x.ply").mesh.triangles.size() == 1);
  CHECK(parsed(head + "0 0 0\n1 0 0\n\n 0 1 0\n3 0\n 1 2\n", "x.ply").mesh.triangles.size() == 1);
  CHECK_THAT(refusal(head + "0 0 0 7\n1 0 0\n0 1 0\n3 0 1 2\n", "x.ply"),
             StartsWith("x.ply:10: unexpected value \"7\""));
  CHECK_THAT(refusal(head + "0 0\n1 0 0\n0 1 0\n3 0 1 2\n", "x.ply"),
             StartsWith("x.ply:11: unexpected value \"0\""));
}

TEST_CASE("PLY headers may end their lines in any way, and data may begin with a line feed") {
  PolygonMesh mesh = tetrahedron();
  // The first data byte of this float is a line feed.
  const std::uint32_t bits = 0x3F80000A;
  float x;
  std::memcpy(&x, &bits, 4);
  mesh.vertices[0].x = x;
  const std::string bytes = ply_binary(mesh, false);
  const std::size_t head = bytes.find("end_header\n") + 11;
  for (const std::string line_end : {"\n", "\r\n", "\r"}) {
    std::string header;
    for (const char c : bytes.substr(0, head)) header += c == '\n' ? line_end : std::string(1, c);
    const MeshFile file = parsed(header + bytes.substr(head), "x.ply");
    CHECK(file.mesh.vertices == mesh.vertices);
    CHECK(file.mesh.triangles.size() == 4);
  }
  // Only the last line with CR LF, as VCGLIB's headers edited on Windows have it.
  std::string mixed = bytes;
  mixed.insert(head - 1, 1, '\r');
  CHECK(parsed(mixed, "x.ply").mesh.vertices == mesh.vertices);
}

TEST_CASE("what follows the last PLY element is told, and faces whose vertices were cut off are dropped") {
  CHECK(parsed(ply_text(box()) + "\n\n", "x.ply").warnings.empty());
  CHECK(parsed(ply_text(box()) + "3 0 1 2\n", "x.ply").warnings.at(0) ==
        "x.ply:24: 8 bytes after the last announced element ignored");
  const std::string bytes = ply_binary(box(), false);
  CHECK(parsed(bytes + "12345", "x.ply").warnings.at(0) ==
        fmt::format("x.ply@{}: 5 bytes after the last announced element ignored", bytes.size()));

  const std::string faces_first =
      "ply\nformat ascii 1.0\nelement face 2\nproperty list uchar int vertex_indices\n"
      "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
      "end_header\n3 0 1 2\n3 1 2 3\n0 0 0\n1 0 0\n0 1 0\n";
  CHECK_THAT(refusal(faces_first, "x.ply"),
             Contains("announces 4 vertices") || Contains("data ends in vertex 4"));
  MeshReadOptions salvage;
  salvage.salvage = true;
  const MeshFile file = parsed(faces_first, "x.ply", salvage);
  CHECK(file.mesh.triangles == std::vector<Triangle>{{0, 1, 2}});
  CHECK(file.warnings.at(1) == "x.ply:11: 1 face dropped with the vertices that were cut off");
}

TEST_CASE("row 25: OFF headers come alone, glued, on one line, with prefixes, comments and without") {
  const std::string body = off_text(box()).substr(4);
  const auto check = [](const std::string& text) { check_box(parsed(text, "x.off"), "off"); };
  check("OFF" + body);
  check("OFF " + body);
  check("off\n" + body);
  check("# first\n\n  # second\nOFF # third\n#fourth\n" + body);
  check(body); // without the word
  std::string commented = "OFF\n";
  for (const char c : body) commented += c == '\n' ? std::string(" # so\n# and so\n\n") : std::string(1, c);
  check(commented);
  std::string one_line = "OFF " + body;
  for (char& c : one_line)
    if (c == '\n') c = ' ';
  check(one_line);
  std::string short_counts = body;
  short_counts.replace(0, 5, "8 6"); // "8 6 0": the edges left out
  check("OFF\n" + short_counts);
  check("appearance { +smooth texture { file a.png } }\nOFF\n" + body);

  // Values after the coordinates, as the prefix says or just there; colours after faces.
  struct Variant {
    const char* word;
    const char* values;
  };
  for (const auto& [word, values] :
       {Variant{"COFF", " 0.1 0.2 0.3 1"}, Variant{"NOFF", " 0 0 1"}, Variant{"STOFF", " 0.5 0.5"},
        Variant{"STCNOFF", " 0 0 1 255 0 0 255 .5 .5"}, Variant{"OFF", " 255 0 0 255"},
        Variant{"CNOFF", " 0 0 1 1 1 1 1"}}) {
    CAPTURE(word);
    std::string text = word, flat = word;
    int line = 0;
    for (const char c : "\n" + body) {
      if (c == '\n' && line >= 2 && line < 10) text += values;
      if (c == '\n' && line >= 10) text += " 0.5 0.5 0.25";
      text += c;
      if (c == '\n' && line >= 2 && line < 10) flat += values;
      flat += c == '\n' ? ' ' : c;
      if (c == '\n') ++line;
    }
    check(text);
    if (std::string(word) != "OFF") check(flat);
  }
}

TEST_CASE("row 25: OFF kinds that are not read are refused by name") {
  const std::string body = off_text(tetrahedron()).substr(4);
  for (const char* word : {"4OFF", "nOFF", "4nOFF", "C4OFF"})
    CHECK(refusal(std::string(word) + "\n" + body, "x.off") ==
          "x.off:1: 4OFF and nOFF (coordinates of other dimensions) are not supported");
  CHECK_THAT(refusal("OFF BINARY\n" + std::string(40, '\1'), "x.off"),
             StartsWith("x.off:1: binary OFF is not supported"));
  CHECK_THAT(refusal("LIST\n{ = OFF\n" + body, "x.off"), Contains("is this OFF?"));
}

TEST_CASE("row 28: STL files with odd names, cases and solids load") {
  check_box(parsed(stl_binary(box(), "solid by a writer that should know better"), "x.stl"), "stl");
  check_box(parsed(stl_binary(box(), std::string("solid\0\0 facet", 12)), "x.stl"), "stl");
  check_box(parsed(stl_binary(box(), "ply by way of OFF"), "x.stl"), "stl");
  check_box(parsed(stl_binary(box(), "off the shelf"), "x"), "stl");
  std::string upper = stl_text(box());
  for (char& c : upper) c = static_cast<char>(c >= 'a' && c <= 'z' ? c - 'a' + 'A' : c);
  check_box(parsed(upper, "x.stl"), "stl");
  check_box(parsed("solid empty\nendsolid empty\n" + stl_text(box(), "facet normal") + "solid\nendsolid\n",
                   "x.stl"),
            "stl");

  const PolygonMesh whole = box();
  PolygonMesh half = whole, rest = whole;
  half.polygons.resize(3);
  rest.polygons.erase(rest.polygons.begin(), rest.polygons.begin() + 3);
  check_box(parsed(stl_text(half, "") + stl_text(rest, "b"), "x.stl"), "stl");

  std::string spaced = stl_text(box());
  for (std::size_t at; (at = spaced.find("endloop")) != std::string::npos;) spaced.replace(at, 7, "end loop");
  check_box(parsed(spaced, "x.stl"), "stl");
  // Old writers leave the normal out; others write what is none.
  std::string bare = stl_text(box());
  for (std::size_t at; (at = bare.find(" normal 0 0 0")) != std::string::npos;) bare.erase(at, 13);
  check_box(parsed(bare, "x.stl"), "stl");
}

TEST_CASE("an ASCII STL that ends inside a facet is refused, or salvaged up to it") {
  const std::string text = stl_text(tetrahedron());
  const std::size_t third = text.find("facet", text.find("endfacet", text.find("endfacet") + 1) + 8);
  const std::size_t close = text.find("endfacet", third);
  MeshReadOptions salvage;
  salvage.salvage = true;
  for (std::size_t cut = third + 5; cut < close + 8; ++cut) {
    CAPTURE(cut);
    const std::string part = text.substr(0, cut);
    CHECK_THAT(refusal(part, "x.stl"), StartsWith("x.stl:16: file ends inside facet 3; --salvage"));
    CHECK(parsed(part, "x.stl", salvage).mesh.triangles.size() == 2);
  }
  const MeshFile open = parsed(text.substr(0, text.rfind("endsolid")), "x.stl");
  CHECK(open.mesh.triangles.size() == 4);
  CHECK_THAT(open.warnings.at(0), Contains("no \"endsolid\" after 4 facets"));
  CHECK_THAT(
      refusal(
          "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nendloop\nendfacet\nendsolid\n",
          "x.stl"),
      StartsWith("x.stl:6: \"endloop\" where \"vertex\" should be"));
}

TEST_CASE("reading does not depend on the locale") {
  const std::string before = std::setlocale(LC_ALL, nullptr);
  bool comma = false;
  for (const char* name : {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8", "de_DE"})
    comma = comma || std::setlocale(LC_ALL, name) != nullptr;
  if (!comma) WARN("no locale with a decimal comma is installed; tested in the C locale only");
  check_box(parsed(obj_text(box()), "x.obj"), "obj");
  std::setlocale(LC_ALL, before.c_str());
}

TEST_CASE("reading stops when a cancellation is asked for") {
  // The request stays for the whole process, so a child makes it.
  const std::string text = obj_text(box());
  const pid_t child = ::fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    request_cancel();
    try {
      parsed(text, "x.obj");
    } catch (const Cancelled&) {
      ::_exit(42);
    } catch (...) {
    }
    ::_exit(1);
  }
  int status = 0;
  REQUIRE(::waitpid(child, &status, 0) == child);
  CHECK(WIFEXITED(status));
  CHECK(WEXITSTATUS(status) == 42);
}
