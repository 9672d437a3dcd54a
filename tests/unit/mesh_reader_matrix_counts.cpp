// Rows 18 to 29 of the bad inputs: PLY headers and bodies, and counts that the file does not hold.
#include "support/mesh_texts.hpp"

using namespace levelray;
using namespace levelray::test;
using Catch::Matchers::Contains;
using Catch::Matchers::Equals;
using Catch::Matchers::StartsWith;

TEST_CASE("row 18: a PLY header without an end is refused after 64 KiB") {
  const std::string header = ply_header("ascii", 4, 4);
  for (std::size_t cut = 5; cut + 12 < header.size(); ++cut)
    CHECK_THAT(refusal(header.substr(0, cut), "x.ply"), StartsWith("x.ply"));
  CHECK_THAT(refusal(header.substr(0, header.find("end_header")), "x.ply"),
             Equals("x.ply: header not terminated; no \"end_header\""));
  std::string endless = "ply\nformat ascii 1.0\n";
  while (endless.size() < 1000000) endless += "comment and so on\n";
  CHECK_THAT(refusal(endless + header.substr(21), "x.ply"),
             StartsWith("x.ply: header not terminated within 65536"));
  CHECK_THAT(refusal("ply\nproperty float x\nend_header\n", "x.ply"),
             StartsWith("x.ply:2: property before any"));
}

TEST_CASE("row 19: a PLY body that ends too early says where") {
  const std::string text = ply_text(tetrahedron());
  CHECK_THAT(refusal(text.substr(0, text.size() - 10), "x.ply"),
             StartsWith("x.ply:16: 4 faces announced, data ends in face 3"));
  const std::string bytes = ply_binary(tetrahedron(), false);
  CHECK_THAT(refusal(bytes.substr(0, bytes.size() - 20), "x.ply"),
             StartsWith(fmt::format("x.ply@{}: 4 faces announced, data ends in face 3", bytes.size() - 26)));
  MeshReadOptions salvage;
  salvage.salvage = true;
  const MeshFile file = parsed(bytes.substr(0, bytes.size() - 20), "x.ply", salvage);
  CHECK(file.mesh.triangles.size() == 2);
  REQUIRE(file.warnings.size() == 1);
  CHECK_THAT(file.warnings[0], Contains("data ends in face 3; what is there was taken"));
}

TEST_CASE("row 20: announced counts are checked against the file's size") {
  const auto with_vertices = [](const std::string& format, const std::string& count) {
    return "ply\nformat " + format + " 1.0\nelement vertex " + count +
           "\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
           "property list uchar int vertex_indices\nend_header\n0 0 0\n";
  };
  CHECK(refusal(with_vertices("binary_little_endian", "4000000000"), "x.ply") ==
        "x.ply:3: announces 4000000000 vertices (48 GB) but the file has 6 bytes left for them");
  CHECK(refusal(with_vertices("ascii", "4000000000"), "x.ply") ==
        "x.ply:3: announces 4000000000 vertices (24 GB) but the file has 6 bytes left for them");
  CHECK(refusal(with_vertices("ascii", "-5"), "x.ply") == "x.ply:3: announces -5 vertices");
  CHECK_THAT(refusal(with_vertices("ascii", "many"), "x.ply"),
             StartsWith("x.ply:3: element \"vertex\" announces"));
  CHECK_THAT(refusal(with_vertices("ascii", "99999999999999999999999"), "x.ply"),
             StartsWith("x.ply:3: announces 9223372036854775807 vertices"));
  CHECK_THAT(refusal("OFF\n4000000000 1 0\n0 0 0\n", "x.off"),
             StartsWith("x.off:2: announces 4000000000 vertices (at least 24 GB) but the file has"));
  CHECK_THAT(refusal("OFF\n-3 1 0\n0 0 0\n", "x.off"), Equals("x.off:2: announces -3 vertices"));
  MeshReadOptions small;
  small.max_memory = 100;
  CHECK_THAT(refusal(ply_text(box()), "x.ply", small, ErrorKind::limit), Contains("--max-memory"));
  CHECK_THAT(refusal(obj_text(box()), "x.obj", small, ErrorKind::limit), Contains("--max-memory"));
}

TEST_CASE("row 21: a polygon with an absurd number of corners is refused") {
  const std::string body = std::string(36, '\0') + bytes_of(std::int32_t{2147483647}) + std::string(12, '\0');
  const std::string header = ply_header("binary_little_endian", 3, 1, "float", "int");
  CHECK(refusal(header + body, "x.ply") ==
        fmt::format("x.ply@{}: polygon with 2147483647 corners exceeds limit 65535", header.size() + 36));
  CHECK(refusal("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n2147483647 0 1 2\n", "x.off") ==
        "x.off:6: polygon with 2147483647 corners exceeds limit 65535");
  std::string face = std::string("v 0 0 0\nv 1 0 0\nv 0 1 0\nf");
  for (int i = 0; i < 70000; ++i) face += " 1";
  CHECK(refusal(face + "\n", "x.obj") == "x.obj:4: polygon with more than 65535 corners");
}

TEST_CASE("row 22: all PLY count types, texture lists, extra properties and any order of elements load") {
  const TriangleMesh plain = parsed(ply_text(box()), "x.ply").mesh;
  const auto same = [&](const std::string& bytes) {
    const MeshFile file = parsed(bytes, "x.ply");
    CHECK(file.mesh.vertices == plain.vertices);
    CHECK(file.mesh.triangles == plain.triangles);
  };
  const auto body = [](auto count, auto index, const std::string& before, const std::string& after) {
    std::string bytes;
    for (const Vec3d& v : box().vertices)
      for (const double x : {v.x, v.y, v.z}) bytes += bytes_of(static_cast<float>(x));
    for (const auto& polygon : box().polygons) {
      bytes += before + bytes_of(static_cast<decltype(count)>(polygon.size()));
      for (const std::uint32_t v : polygon) bytes += bytes_of(static_cast<decltype(index)>(v));
      bytes += after;
    }
    return bytes;
  };
  const auto header = [](const std::string& count, const std::string& index) {
    return ply_header("binary_little_endian", 8, 6, "float", count, index);
  };
  same(header("char", "short") + body(std::int8_t{}, std::int16_t{}, "", ""));
  same(header("uchar", "ushort") + body(std::uint8_t{}, std::uint16_t{}, "", ""));
  same(header("ushort", "uint") + body(std::uint16_t{}, std::uint32_t{}, "", ""));
  same(header("short", "uchar") + body(std::int16_t{}, std::uint8_t{}, "", ""));
  same(header("uint", "char") + body(std::uint32_t{}, std::int8_t{}, "", ""));
  same(header("int32", "int32") + body(std::int32_t{}, std::int32_t{}, "", ""));
  // A texture list and a scalar around the indices.
  const std::string list = "property list uchar float texcoord\n", scalar = "property uchar red\n";
  const std::string texture = std::string(1, '\2') + bytes_of(0.5f) + bytes_of(0.25f);
  std::string wide = header("uchar", "int");
  const std::size_t indices = wide.find("property list");
  wide.insert(indices, scalar + list);
  wide.insert(wide.find("end_header"), "property list uchar float more\nproperty double quality\n");
  same(wide + body(std::uint8_t{}, std::int32_t{}, "R" + texture, texture + bytes_of(1.0)));
  // Faces before vertices, other elements before, between and after, in text.
  std::string mixed =
      "ply\r\nformat ascii 1.0\r\ncomment element vertex 9\r\nelement material 2\r\n"
      "property list uint float values\r\nelement face 6\r\nproperty list int uint vertex_index\r\n"
      "element nothing 4000000000\r\nelement edge 1\r\nproperty int vertex1\r\nproperty int vertex2\r\n"
      "element vertex 8\r\nproperty float nx\r\nproperty double z\r\nproperty double y\r\n"
      "property double x\r\nobj_info made by hand\r\nend_header\r\n0\r\n3 1 2 3\r\n";
  for (const auto& polygon : box().polygons)
    mixed += fmt::format("4 {} {} {} {}\r\n", polygon[0], polygon[1], polygon[2], polygon[3]);
  mixed += "0 1\r\n";
  for (const Vec3d& v : box().vertices) mixed += fmt::format("1 {} {} {}\r\n", v.z, v.y, v.x);
  same(mixed);
  CHECK_THAT(parsed(mixed, "x.ply").warnings.at(0),
             Contains("material elements, ") && Contains("edge elements ignored"));
}

TEST_CASE("row 24: unknown PLY types, formats and versions are named with their line") {
  const auto header = [](const std::string& format, const std::string& type) {
    return "ply\nformat " + format + "\nelement vertex 1\nproperty " + type + " x\nend_header\n";
  };
  CHECK(refusal(header("ascii 1.0", "floaty"), "x.ply") == "x.ply:4: unknown type \"floaty\"");
  CHECK(refusal(header("ascii 1.0", "list float int"), "x.ply") == "x.ply:4: list count of type \"float\"");
  CHECK_THAT(refusal(header("ascii 2.0", "float"), "x.ply"),
             StartsWith("x.ply:2: unknown format version \"2.0\""));
  CHECK_THAT(refusal(header("binary 1.0", "float"), "x.ply"),
             StartsWith("x.ply:2: unknown format \"binary\""));
  CHECK_THAT(refusal("ply\nelement vertex 0\nend_header\n", "x.ply"), Contains("no \"format\" line"));
  CHECK_THAT(refusal(header("ascii 1.0", "float") + "0\n", "x.ply"),
             StartsWith("x.ply:3: element vertex lacks"));
}

TEST_CASE("row 26: an OFF file with fewer faces than announced says how many it found") {
  std::string text = off_text(tetrahedron());
  text.resize(text.rfind("3 1 2 3"));
  CHECK_THAT(refusal(text, "x.off"), Contains(": announces 4 faces, found 2; --salvage"));
  MeshReadOptions salvage;
  salvage.salvage = true;
  CHECK(parsed(text, "x.off", salvage).mesh.triangles.size() == 2);
  CHECK_THAT(refusal("OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n", "x.off"),
             Contains(": announces 4 vertices, found 3"));
  const MeshFile more = parsed(off_text(tetrahedron()) + "3 0 1 2\n", "x.off");
  REQUIRE(more.warnings.size() == 1);
  CHECK(more.warnings[0] == "x.off:11: data after the last announced face ignored");
}

TEST_CASE("row 27: a binary STL whose count and size disagree is refused, or salvaged") {
  const auto with_count = [](std::uint32_t count, std::size_t size) {
    std::string bytes = stl_binary(tetrahedron());
    bytes.replace(80, 4, bytes_of(count));
    bytes.resize(size, '\0');
    return bytes;
  };
  CHECK_THAT(refusal(with_count(8, 284), "x.stl"),
             StartsWith("x.stl@80: announces 8 triangles, file holds 4; --salvage"));
  CHECK_THAT(refusal(with_count(0, 284), "x.stl"),
             StartsWith("x.stl@80: announces 0 triangles, file holds 4"));
  CHECK_THAT(refusal(with_count(4294967295u, 284), "x.stl"),
             Contains("announces 4294967295 triangles, file holds 4"));
  CHECK_THAT(refusal(with_count(4, 260), "x.stl"), Contains("announces 4 triangles, file holds 3"));
  MeshReadOptions salvage;
  salvage.salvage = true;
  for (const std::uint32_t count : {0u, 8u, 4294967295u}) {
    const MeshFile file = parsed(with_count(count, 284), "x.stl", salvage);
    CHECK(file.mesh.triangles.size() == 4);
    CHECK(signed_volume(file.mesh) == Approx(1.0 / 6));
    CHECK(file.warnings.size() == 1);
  }
  CHECK(parsed(with_count(4, 300), "x.stl").warnings.at(0) ==
        "x.stl: 16 bytes after the last triangle ignored");
}

TEST_CASE("row 29: an STL file below 84 bytes that is no text is too short") {
  CHECK(refusal(stl_binary(tetrahedron()).substr(0, 83), "x.stl") == "x.stl: too short for STL: 83 bytes");
  CHECK(refusal("solid", "x.stl") == "x.stl: no vertices or faces found; is this STL?");
  CHECK(refusal("abcde", "x.stl") == "x.stl: too short for STL: 5 bytes");
}
