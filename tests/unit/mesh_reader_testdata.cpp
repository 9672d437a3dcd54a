// Real files that nobody here wrote: what their list says of them is what must come out.
#include "support/mesh_texts.hpp"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <map>

using namespace levelray;
using namespace levelray::test;
using Catch::Matchers::Contains;

namespace {

const std::filesystem::path testdata = LEVELRAY_TESTDATA;

bool present(const char* folder) {
  if (std::filesystem::is_directory(testdata / folder)) return true;
  WARN("not tested: no test data at " << (testdata / folder).string());
  return false;
}

std::vector<std::filesystem::path> meshes_in(const char* folder) {
  std::vector<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::directory_iterator(testdata / folder)) {
    std::string extension = entry.path().extension().string();
    for (char& c : extension) c = static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
    if (extension == ".obj" || extension == ".ply" || extension == ".stl" || extension == ".off")
      paths.push_back(entry.path());
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

struct Listed {
  std::uint64_t vertices, faces, n_gons;
};

std::uint64_t number_in(const std::string& text) {
  std::uint64_t n = 0;
  for (const char c : text)
    if (c >= '0' && c <= '9') n = 10 * n + static_cast<std::uint64_t>(c - '0');
  return n;
}

// The rows "| folder/file | source | licence | V / F | …" of the list; "N n-gons" may stand in the notes.
std::map<std::string, Listed> listed_meshes() {
  std::map<std::string, Listed> rows;
  std::ifstream file(testdata / "README.md");
  for (std::string line; std::getline(file, line);) {
    std::vector<std::string> cells;
    for (std::size_t from = 0, to; (to = line.find('|', from)) != std::string::npos; from = to + 1)
      cells.push_back(line.substr(from, to - from));
    if (cells.size() < 6) continue;
    const std::size_t slash = cells[4].find(" / ");
    if (slash == std::string::npos) continue;
    const std::string name = cells[1].substr(1, cells[1].size() - 2);
    std::uint64_t polygons = 0; // the last "N n-gons" of the notes
    if (const std::size_t n_gons = line.rfind(" n-gons"); n_gons != std::string::npos) {
      const std::size_t from = line.find_last_of("|;", n_gons);
      polygons = number_in(line.substr(from, n_gons - from));
    }
    rows[name] = {number_in(cells[4].substr(0, slash)), number_in(cells[4].substr(slash)), polygons};
  }
  return rows;
}

// A line of /proc/self/status, in kB; 0 where there is no such thing.
std::uint64_t process_memory(const std::string& key) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.compare(0, key.size(), key) == 0) return number_in(line);
  return 0;
}

} // namespace

TEST_CASE("classic and hard files give the counts that their list states") {
  if (!present("classic") || !present("hard")) return;
  const std::map<std::string, Listed> rows = listed_meshes();
  REQUIRE(rows.size() > 50);
  for (const char* folder : {"classic", "hard"})
    for (const std::filesystem::path& path : meshes_in(folder)) {
      const std::string name = std::string(folder) + "/" + path.filename().string();
      CAPTURE(name);
      const auto row = rows.find(name);
      REQUIRE(row != rows.end());
      const MeshFile file = read_mesh(path.string());
      REQUIRE(is_sound(file.mesh));
      CHECK(file.mesh.vertices.size() == row->second.vertices);
      if (name == "classic/igea-tristrips.ply") {
        CHECK(file.mesh.triangles.size() == 268686);
      } else if (row->second.n_gons == 0) {
        CHECK(file.mesh.triangles.size() == row->second.faces);
      } else {
        CHECK(file.mesh.triangles.size() >= row->second.faces + row->second.n_gons);
      }
    }
}

TEST_CASE("meshes of quads and polygons give the triangles that their polygons have") {
  if (!present("hard")) return;
  const auto triangles = [](const char* name) {
    return read_mesh((testdata / name).string()).mesh.triangles.size();
  };
  CHECK(triangles("hard/gc-moebius.obj") == 2 * 224);
  CHECK(triangles("hard/gc-dodecahedron_poly.obj") == 3 * 12);
  CHECK(triangles("hard/trimesh-negative_indices.obj") == 2 * 6);
  CHECK(triangles("hard/trimesh-quadknot.obj") == 2 * 1440);
  CHECK(triangles("classic/suzanne.obj") == 500 + 468);
  CHECK(triangles("hard/assimp-concave_polygon.obj") == 66 - 2);
  CHECK_THROWS_WITH(read_mesh((testdata / "hard/foam-motorBike.obj.gz").string()),
                    Contains("gunzip it first"));
}

TEST_CASE("hostile files end in a sound mesh or one line, soon and in little memory") {
  if (!present("hostile")) return;
  const auto paths = meshes_in("hostile");
  REQUIRE(paths.size() > 90);
  const std::uint64_t before = process_memory("VmRSS");
  const bool measured = before != 0 && (std::ofstream("/proc/self/clear_refs") << 5 << std::flush).good();
  if (!measured) WARN("memory not measured: the system does not tell its peak");
  for (const std::filesystem::path& path : paths)
    for (const bool lenient : {false, true}) {
      CAPTURE(path.string(), lenient);
      MeshReadOptions options;
      options.salvage = options.drop_bad = lenient;
      const auto start = std::chrono::steady_clock::now();
      try {
        const MeshFile file = read_mesh(path.string(), options);
        CHECK(is_sound(file.mesh));
        CHECK(!file.mesh.triangles.empty());
      } catch (const Error& error) {
        const std::string text = error.what();
        CHECK(error.kind() == ErrorKind::bad_input);
        CHECK(text.size() <= 500);
        CHECK(text.find('\n') == std::string::npos);
        CHECK_THAT(text, Contains(path.filename().string()));
      }
      CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(10));
    }
  if (measured) CHECK(process_memory("VmHWM") < before + (1 << 20)); // 1 GiB
}

TEST_CASE("of the hostile files, those that are legal give the right mesh") {
  if (!present("hostile")) return;
  const std::map<std::string, std::size_t> triangles = {{"assimp-box_without_lineending.obj", 12},
                                                        {"assimp-cube_binary_header_with_RN_newline.ply", 12},
                                                        {"assimp-cube_binary_starts_with_nl.ply", 12},
                                                        {"assimp-multiple_spaces.obj", 1},
                                                        {"assimp-testmixed.obj", 12},
                                                        {"assimp-triangle_with_empty_solid.stl", 1},
                                                        {"geomview-cube.off", 12},
                                                        {"geomview-textured-dodec.off", 36},
                                                        {"tinyobj-cube-vertex-w-component.obj", 12},
                                                        {"tinyobj-issue-161-inconsistent-f.obj", 12},
                                                        {"tinyobj-issue-295-trianguation-failure.obj", 28},
                                                        {"tinyobj-leading-decimal-dot-issue-201.obj", 1},
                                                        {"trimesh-comments.off", 12},
                                                        {"trimesh-multi.ply", 2},
                                                        {"trimesh-nancolor.obj", 12},
                                                        {"trimesh-obj_with_no_face_in_chunk.obj", 1},
                                                        {"trimesh-singlevn.obj", 2},
                                                        {"trimesh-whitespace.off", 12}};
  for (const auto& [name, count] : triangles) {
    CAPTURE(name);
    CHECK(read_mesh((testdata / "hostile" / name).string()).mesh.triangles.size() == count);
  }
}
