// Damaged mesh files, made from small whole ones: every one must end in a mesh that keeps its promises or in
// an Error of one line. Run it under the address and undefined-behaviour sanitizers too.
#include "support/mesh_texts.hpp"

#include <algorithm>
#include <chrono>
#include <functional>
#include <random>

using namespace levelray;
using namespace levelray::test;

namespace {

constexpr std::uint64_t seed = 20261122;
constexpr int mutants_per_format = 100000;

using Random = std::mt19937_64;

std::size_t below(Random& random, std::size_t n) {
  return n == 0 ? 0 : static_cast<std::size_t>(random() % n);
}

// A ball of latitude bands with polygons as caps: triangles, quads and n-gons.
PolygonMesh ball() {
  PolygonMesh mesh;
  const std::uint32_t rings = 4, sides = 9;
  for (std::uint32_t r = 0; r < rings; ++r)
    for (std::uint32_t s = 0; s < sides; ++s) {
      const double u = 0.3 + 0.8 * r, v = 0.7 * s;
      mesh.vertices.push_back({std::sin(u) * std::cos(v), std::sin(u) * std::sin(v), std::cos(u)});
    }
  std::vector<std::uint32_t> top, bottom;
  for (std::uint32_t s = 0; s < sides; ++s) {
    top.push_back(s);
    bottom.push_back((rings - 1) * sides + (sides - 1 - s));
  }
  mesh.polygons = {top, bottom};
  for (std::uint32_t r = 0; r + 1 < rings; ++r)
    for (std::uint32_t s = 0; s < sides; ++s) {
      const std::uint32_t a = r * sides + s, b = r * sides + (s + 1) % sides;
      mesh.polygons.push_back({a, a + sides, b + sides, b});
    }
  return mesh;
}

std::vector<std::string> corpus(const std::string& format) {
  const PolygonMesh meshes[] = {tetrahedron(), box(), ball()};
  std::vector<std::string> files;
  for (const PolygonMesh& mesh : meshes) {
    if (format == "obj") {
      files.push_back(obj_text(mesh));
      std::string rich =
          "# rich\nmtllib a.mtl\nvt 0 0\nvn 0 0 1\n" + obj_text(mesh) + "f -1//1 -2//1 -3//1\nl 1 2\n";
      for (std::size_t at; (at = rich.find("\nf 1 ")) != std::string::npos;)
        rich.replace(at, 5, "\nf 1/1/1 \\\n ");
      files.push_back(rich);
    } else if (format == "off") {
      files.push_back(off_text(mesh));
      std::string flat = off_text(mesh);
      std::replace(flat.begin(), flat.end(), '\n', ' ');
      files.push_back(flat);
      files.push_back("# a\nC" + off_text(mesh) + "# end\n");
    } else if (format == "stl") {
      files.push_back(stl_text(mesh));
      files.push_back(stl_binary(mesh));
      files.push_back(stl_binary(mesh, "solid no"));
    } else {
      files.push_back(ply_text(mesh));
      files.push_back(ply_binary(mesh, false));
      files.push_back(ply_binary(mesh, true));
    }
  }
  if (format == "ply") {
    files.push_back(
        "ply\nformat ascii 1.0\nelement tristrips 1\nproperty list int int vertex_indices\nelement vertex 4\n"
        "property double x\nproperty double y\nproperty double z\nproperty list uchar float w\nend_header\n"
        "6 0 1 2 3 -1 2\n0 0 0 0\n1 0 0 1 2\n0 1 0 0\n0 0 1 0\n");
    files.push_back(
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\nproperty double y\nproperty double z\n"
        "element tristrips 1\nproperty list int int vertex_indices\nend_header\n"
        "0 0 0\n1 0 0\n0 1 0\n0 0 1\n6 0 1 2 3 -1 2\n");
  }
  return files;
}

const char* const interesting[] = {"0",
                                   "-1",
                                   "1",
                                   "2147483647",
                                   "-2147483648",
                                   "4294967295",
                                   "4294967296",
                                   "65535",
                                   "65536",
                                   "18446744073709551616",
                                   "1e308",
                                   "1e-320",
                                   "1e400",
                                   "nan",
                                   "-inf",
                                   "0.5",
                                   "",
                                   "-",
                                   "+",
                                   ".",
                                   "e",
                                   "1e",
                                   "0x1",
                                   "1,5",
                                   "9",
                                   "255",
                                   "-99999999999999999999"};

// Replaces one number of the text, or four bytes of a binary file.
void edit_number(std::string& bytes, Random& random) {
  const std::size_t start = below(random, bytes.size());
  std::size_t from = bytes.find_first_of("0123456789", start);
  if (random() % 4 == 0 || from == std::string::npos) {
    const std::uint32_t values[] = {0,          1,          0x7FFFFFFF, 0x80000000,
                                    0xFFFFFFFF, 0x7F800000, 0x7FC00000, 0x00010000};
    if (start + 4 <= bytes.size())
      bytes.replace(start, 4, bytes_of(values[below(random, std::size(values))]));
    return;
  }
  std::size_t to = bytes.find_first_not_of("0123456789.eE+-", from);
  if (to == std::string::npos) to = bytes.size();
  bytes.replace(from, to - from, interesting[below(random, std::size(interesting))]);
}

std::string mutated(const std::vector<std::string>& files, Random& random) {
  std::string bytes = files[below(random, files.size())];
  const std::size_t edits = 1 + below(random, 4);
  for (std::size_t edit = 0; edit < edits && !bytes.empty(); ++edit) {
    const std::size_t at = below(random, bytes.size()), length = below(random, 1 + random() % 64);
    switch (random() % 8) {
    case 0:
      bytes[at] = static_cast<char>(bytes[at] ^ (1 << random() % 8));
      break;
    case 1:
      bytes[at] = static_cast<char>(random());
      break;
    case 2:
      bytes.resize(at);
      break;
    case 3: {
      std::string noise;
      for (std::size_t i = 0; i < length; ++i) noise += static_cast<char>(random());
      bytes.insert(at, noise);
      break;
    }
    case 4:
      bytes.insert(at, bytes.substr(below(random, bytes.size()), length));
      break;
    case 5:
      bytes.erase(at, length);
      break;
    case 6: { // a line doubled, or taken from another file
      const std::string& other = files[below(random, files.size())];
      const std::size_t line = other.find('\n', below(random, other.size()));
      if (line != std::string::npos) bytes.insert(at, other.substr(line, other.find('\n', line + 1) - line));
      break;
    }
    default:
      edit_number(bytes, random);
    }
  }
  return bytes;
}

struct Outcome {
  int meshes = 0, refusals = 0;
};

void run(const std::string& format) {
  Random random(seed + format[0] * 7919u + format[1]);
  const std::vector<std::string> files = corpus(format);
  const std::string name = "mutant." + format;
  Outcome outcome;
  for (const std::string& whole : files)
    if (whole.find("tristrips") == std::string::npos) REQUIRE(!parsed(whole, name).mesh.triangles.empty());

  for (int i = 0; i < mutants_per_format; ++i) {
    const std::string text = mutated(files, random);
    // An exact copy on the heap, so that a read beyond the end is seen.
    const std::vector<char> bytes(text.begin(), text.end());
    MeshReadOptions options;
    options.max_memory = 1 << 24;
    options.salvage = random() % 3 == 0;
    options.drop_bad = random() % 3 == 0;
    if (random() % 2 == 0) options.format = format;
    std::string problem;
    try {
      const MeshFile file = parse_mesh(bytes.data(), bytes.size(), name, options);
      if (!is_sound(file.mesh) || file.mesh.triangles.empty()) problem = "a mesh that breaks its promises";
      for (const std::string& warning : file.warnings)
        if (warning.empty()) problem = "an empty remark";
      ++outcome.meshes;
    } catch (const Error& error) {
      const std::string what = error.what();
      if (what.size() > 500 || what.find('\n') != std::string::npos || what.find("mutant") != 0)
        problem = "a bad message: " + what;
      ++outcome.refusals;
    }
    if (!problem.empty()) {
      CAPTURE(seed, format, i, options.salvage, options.drop_bad, text);
      FAIL(problem);
    }
  }
  INFO(format << ": " << outcome.meshes << " meshes, " << outcome.refusals << " refusals");
  CHECK(outcome.meshes > 0);
  CHECK(outcome.refusals > mutants_per_format / 10);
}

} // namespace

TEST_CASE("a hundred thousand damaged OBJ files end in sound meshes or errors of one line") {
  run("obj");
}
TEST_CASE("a hundred thousand damaged PLY files end in sound meshes or errors of one line") {
  run("ply");
}
TEST_CASE("a hundred thousand damaged STL files end in sound meshes or errors of one line") {
  run("stl");
}
TEST_CASE("a hundred thousand damaged OFF files end in sound meshes or errors of one line") {
  run("off");
}

TEST_CASE("every beginning of every file ends in a sound mesh or an error of one line") {
  for (const std::string& format : mesh_format_names())
    for (const std::string& whole : corpus(format))
      for (std::size_t size = 0; size <= whole.size(); size += whole.size() > 2000 ? 7 : 1) {
        CAPTURE(format, size);
        const std::vector<char> bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
        try {
          if (!is_sound(parse_mesh(bytes.data(), bytes.size(), "part." + format).mesh)) FAIL("unsound");
        } catch (const Error& error) {
          if (std::string(error.what()).size() > 500) FAIL(error.what());
        }
      }
}
