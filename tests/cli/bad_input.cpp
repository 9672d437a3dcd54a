// Files that cannot be used: exit 3 (5 over a limit), one line of at most 500 bytes, no output file. The
// readers' own tests know the messages; this is about what the program makes of them.
#include "support/catch.hpp"
#include "support/mesh_files.hpp"
#include "support/read_output.hpp"
#include "support/run_program.hpp"
#include "support/temporary_folder.hpp"

#include <algorithm>
#include <filesystem>
#include <sys/stat.h>

using namespace levelray::test;

namespace {

struct Row {
  std::string name, content, says;
  int code = 3;
  std::vector<std::string> options = {};
};

void check_refused(const std::string& path, const Row& row, const TemporaryFolder& folder) {
  std::vector<std::string> before = folder.names();
  for (const bool renders : {false, true}) {
    std::vector<std::string> arguments =
        renders ? std::vector<std::string>{"render", path, "-o", folder / "out.png"}
                : std::vector<std::string>{"convert", path, folder / "out.vdb"};
    arguments.insert(arguments.end(), row.options.begin(), row.options.end());
    const RunResult result = run_program(arguments);
    INFO(row.name << ": " << result.err);
    CHECK(result.code == row.code);
    CHECK(result.out.empty());
    CHECK_THAT(result.err, Catch::StartsWith("levelray: ") && Catch::Contains(row.says));
    CHECK(result.err.size() <= 500);
    CHECK(std::count(result.err.begin(), result.err.end(), '\n') == 1);
    CHECK(std::count(result.err.begin(), result.err.end(), '\033') == 0);
    CHECK(folder.names() == before);
  }
}

const std::string ply_header =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
    "property float z\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n";
const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

} // namespace

TEST_CASE("meshes that cannot be used end with 3, one line and no output") {
  const TemporaryFolder folder;
  const std::vector<Row> rows{
      {"empty.obj", "", "empty"},
      {"letter.obj", "Dear all,\nthis is no mesh.\n", "letter.obj"},
      {"points.obj", triangle, "points.obj"},
      {"comma.obj", "v 0,5 0 0\n" + triangle + "f 2 3 4\n", "comma.obj:1"},
      {"nan.obj", "v nan 0 0\n" + triangle + "f 1 2 3\n", "nan.obj:1"},
      {"huge.obj", "v 1e400 0 0\n" + triangle + "f 1 2 3\n", "huge.obj:1"},
      {"index.obj", triangle + "f 1 2 9\n", "index.obj:4"},
      {"zero.obj", triangle + "f 0 1 2\n", "zero.obj:4"},
      {"header.ply", "ply\nformat ascii 1.0\nelement vertex 3\n", "header.ply"},
      {"body.ply", ply_header + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", "body.ply"},
      {"many.ply",
       "ply\nformat binary_little_endian 1.0\nelement vertex 4000000000\nproperty float x\nproperty float y\n"
       "property float z\nend_header\n",
       "4000000000"},
      {"count.off", "OFF\n3 4 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", "count.off"},
      {"short.stl", std::string("\0\0\0\0", 4), "short.stl"},
      {"same.obj", "v 1 1 1\nv 1 1 1\nv 1 1 1\nf 1 2 3\n", "same.obj"},
      {"sheet.obj", triangle + "f 1 2 3\n", "sheet.obj", 3, {"--strict"}},
      {"bytes.obj", std::string("v \033[31m\xff\xfe 0 0\nf 1 2 3\n"), "bytes.obj"},
      {"long.obj", "v " + std::string(100000, 'x') + "\n", "long.obj"},
  };
  for (const Row& row : rows) {
    write_text(folder / row.name, row.content);
    check_refused(folder / row.name, row, folder);
    std::filesystem::remove(folder / row.name);
  }
}

TEST_CASE("paths that are no files are refused") {
  const TemporaryFolder folder;
  check_refused(folder / "missing.obj", {"missing.obj", "", "missing.obj"}, folder);
  check_refused(folder / "missing.vdb", {"missing.vdb", "", "missing.vdb", 3}, folder);
  std::filesystem::create_directory(folder / "folder.obj");
  check_refused(folder / "folder.obj", {"folder.obj", "", "director"}, folder);
  REQUIRE(::mkfifo((folder / "pipe.obj").c_str(), 0600) == 0);
  check_refused(folder / "pipe.obj", {"pipe.obj", "", "pipe.obj"}, folder);
}

TEST_CASE("a grid beyond every limit ends with 5 before memory is taken") {
  const TemporaryFolder folder;
  write_text(folder / "wide.obj", box_obj(1e7, 1, 1));
  check_refused(folder / "wide.obj", {"wide.obj", "", "wide.obj", 5, {"--voxel", "1e-6"}}, folder);
}

TEST_CASE("sizes that numbers cannot hold end with 5 and not with a wrong picture") {
  const TemporaryFolder folder;
  for (const double size : {1e300, 1e60, 1e40, 1e-40, 1e-60, 1e-300}) {
    write_text(folder / "box.obj", box_obj(size, size, size));
    check_refused(folder / "box.obj", {"box.obj", "", "scale the mesh", 5}, folder);
  }
  // Others are as good as any: a power of two changes no digit of any number, hence no pixel.
  const auto picture = [&](double size) {
    write_text(folder / "box.obj", box_obj(size, 0.5 * size, size));
    const RunResult result = run_program(
        {"render", folder / "box.obj", "-o", folder / "out.png", "--resolution", "16", "--size", "32x32"});
    INFO(result.err);
    CHECK(result.code == 0);
    return content_of(folder / "out.png");
  };
  const std::string expected = picture(1);
  for (const double size : {0x1p100, 0x1p70, 0x1p-90}) {
    CAPTURE(size);
    CHECK(picture(size) == expected);
  }
}

TEST_CASE("level sets that cannot be used end with 3") {
  const TemporaryFolder folder;
  write_text(folder / "text.vdb", "this is no level set\n");
  write_text(folder / "empty.vdb", "");
  for (const std::string name : {"text.vdb", "empty.vdb"}) {
    const RunResult result = run_program({"render", folder / name, "-o", folder / "out.png"});
    INFO(result.err);
    CHECK(result.code == 3);
    CHECK_THAT(result.err, Catch::Contains(name));
    CHECK(result.err.size() <= 500);
    CHECK(std::count(result.err.begin(), result.err.end(), '\n') == 1);
    CHECK(run_program({"info", folder / name}).code == 3);
  }
  CHECK(run_program({"convert", folder / "text.vdb", folder / "out.vdb"}).code == 3);
  CHECK(folder.names() == std::vector<std::string>{"empty.vdb", "text.vdb"});
}

TEST_CASE("real files of other kinds are refused with the candidates") {
  const std::string vdb = LEVELRAY_TESTDATA "/vdb/";
  if (!std::filesystem::exists(vdb)) {
    WARN("skipped: no test data in " << vdb);
    return;
  }
  const TemporaryFolder folder;
  for (const auto& [name, says] : std::vector<std::pair<std::string, std::string>>{
           {"smoke_fog_half_v222.vdb", "density"}, {"points.vdb", "points"}, {"velocity_vec3s.vdb", "vel"}}) {
    const RunResult result = run_program({"render", vdb + name, "-o", folder / "out.png"});
    INFO(result.err);
    CHECK(result.code == 3);
    CHECK_THAT(result.err, Catch::Contains(says));
    CHECK(result.err.size() <= 500);
    CHECK(std::count(result.err.begin(), result.err.end(), '\n') == 1);
    CHECK(folder.names().empty());
  }
}

TEST_CASE("info lists the other grids of a file beside one without a surface") {
  const std::string vdb = LEVELRAY_TESTDATA "/sequence/liquid_mantaflow_vdb/fluid_data_0041.vdb";
  if (!std::filesystem::exists(vdb)) {
    WARN("skipped: no test data in " << vdb);
    return;
  }
  const RunResult result = run_program({"info", vdb});
  INFO(result.err);
  CHECK(result.code == 0);
  CHECK_THAT(result.out, Catch::Contains("\"phi_out\": float, class level set: has no surface") &&
                             Catch::Contains("\"phi_previous\": float, class level set: 18,432 active"));
  CHECK_THAT(result.err, Catch::Contains("warning: grid \"phi\": gradients"));
}
