#include "levelray/io/extreme_mesh_files.hpp"

#include "levelray/core/error.hpp"
#include "levelray/io/mesh_reader.hpp"

#include <array>
#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <random>

namespace levelray {

namespace {

MeshFile parsed(const std::string& bytes, const std::string& name) {
  return parse_mesh(bytes.data(), bytes.size(), name);
}

// A tetrahedron in every format.
const std::vector<std::pair<std::string, std::string>>& tetrahedra() {
  static const std::vector<std::pair<std::string, std::string>> all = [] {
    const float corner[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const std::int32_t face[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
    std::string obj, off = "OFF\n4 4 6\n", ascii = "solid t\n";
    std::string ply = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty "
                      "float z\nelement face 4\nproperty "
                      "list uchar int vertex_indices\nend_header\n";
    std::string binary_ply = ply;
    binary_ply.replace(binary_ply.find("ascii"), 5, "binary_little_endian");
    std::string stl(84, '\0');
    const auto raw = [](std::string& to, const auto& value) {
      std::array<char, sizeof value> bytes;
      std::memcpy(bytes.data(), &value, sizeof value);
      to.append(bytes.data(), bytes.size());
    };
    const std::uint32_t count = 4;
    std::memcpy(stl.data() + 80, &count, 4);
    for (const auto& v : corner) {
      const std::string text = fmt::format("{} {} {}\n", v[0], v[1], v[2]);
      obj += "v " + text, off += text, ply += text;
      for (const float x : v) raw(binary_ply, x);
    }
    for (const auto& f : face) {
      obj += fmt::format("f {} {} {}\n", f[0] + 1, f[1] + 1, f[2] + 1);
      off += fmt::format("3 {} {} {}\n", f[0], f[1], f[2]);
      ply += fmt::format("3 {} {} {}\n", f[0], f[1], f[2]);
      raw(binary_ply, static_cast<unsigned char>(3));
      for (const std::int32_t i : f) raw(binary_ply, i);
      ascii += "facet normal 0 0 0\nouter loop\n";
      stl.append(12, '\0');
      for (const std::int32_t i : f) {
        ascii += fmt::format("vertex {} {} {}\n", corner[i][0], corner[i][1], corner[i][2]);
        for (const float x : corner[i]) raw(stl, x);
      }
      ascii += "endloop\nendfacet\n";
      stl.append(2, '\0');
    }
    ascii += "endsolid t\n";
    return std::vector<std::pair<std::string, std::string>>{{"a.obj", obj},   {"a.off", off},
                                                            {"a.ply", ply},   {"b.ply", binary_ply},
                                                            {"a.stl", ascii}, {"b.stl", stl}};
  }();
  return all;
}

// Whole ones first, which must be read; then bytes changed, cut off, put in.
ExtremeOutcome damaged(const ExtremeSettings& settings) {
  ExtremeTally tally;
  std::mt19937_64 random(settings.seed);
  for (const auto& [name, bytes] : tetrahedra()) {
    tally.check(parsed(bytes, name).mesh.triangles.size() == 4,
                [&] { return name + ": the whole file is not read"; });
    for (int i = 0; i < 1500; ++i) {
      std::string bad = bytes;
      const auto place = [&] { return static_cast<std::size_t>(random() % bad.size()); };
      if (i % 5 == 0) bad.resize(1 + place());
      if (i % 7 == 0) bad.insert(place(), bad.substr(place(), 1 + random() % 40));
      const char* const words[] = {"nan", "-1", "1e999", "99999999999", "inf", "\n", "0x", "4294967296"};
      if (i % 3 == 0) bad.insert(place(), words[random() % std::size(words)]);
      for (int k = 0; k < i % 4; ++k) bad[place()] = static_cast<char>(random() & 0xFF);
      tally.add();
      try {
        const MeshFile file = parsed(bad, name);
        bool right = true;
        for (const Triangle& t : file.mesh.triangles)
          for (const std::uint32_t v : t) right &= v < file.mesh.vertices.size();
        for (const Vec3d& v : file.mesh.vertices)
          right &= std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
        tally.check(right, [&] {
          return fmt::format(
              "{}, damage {} of seed {}: indices out of range, or coordinates that are no numbers", name, i,
              settings.seed);
        });
      } catch (const Error& error) {
        tally.check(std::string(error.what()).find('\n') == std::string::npos,
                    [&] { return std::string("more than a line: ") + error.what(); });
      }
    }
  }
  return tally.outcome();
}

ExtremeRow refused(const char* name, const char* expected, const char* text, const std::string& bytes) {
  return {"files", name, expected,
          [=](const ExtremeSettings&) { return expect_refusal(text, [&] { parsed(bytes, "a.obj"); }); }};
}

} // namespace

std::vector<ExtremeRow> extreme_mesh_file_rows() {
  return {
      refused("mesh-nan", "Coordinates that are no numbers are refused with their line.",
              "a.obj:2: non-finite coordinate", "v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n"),
      refused("mesh-inf", "Coordinates beyond what a double holds are refused with their line.",
              "a.obj:2: non-finite coordinate", "v 0 0 0\nv 1e999 0 0\nv 0 1 0\nf 1 2 3\n"),
      refused("mesh-empty-file", "An empty file is refused.", "empty", ""),
      {"files", "mesh-damaged",
       "Damaged .obj, .off, .ply and .stl, text and binary, are read or refused by one line.", damaged},
  };
}

} // namespace levelray
