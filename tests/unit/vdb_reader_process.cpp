// The limited process that reads OpenVDB files, and what its parent makes of a bad one.
#include "levelray/core/error.hpp"
#include "levelray/vdb/vdb_file.hpp"
#include "support/catch.hpp"
#include "support/fake_reader.hpp"
#include "support/sphere_grid.hpp"
#include "support/temporary_folder.hpp"

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>

using namespace levelray;
using namespace levelray::test;

namespace {

std::pair<ErrorKind, std::string> error_of(const std::string& path, const VdbReadOptions& options = {}) {
  try {
    read_vdb(path, options);
  } catch (const Error& error) {
    return {error.kind(), error.what()};
  }
  return {ErrorKind::usage, "no error"};
}

} // namespace

TEST_CASE("the limited process reads what this process reads") {
  const TemporaryFolder dir;
  BlockGrid grid = sphere_grid(20, 3, 0.5);
  grid.transform.origin = Vec3d(0.1, 1e6, -5);
  grid.name = "caf\xC3\xA9";
  write_vdb(dir / "a.vdb", grid);
  VdbReadOptions trusted;
  trusted.trust_input = true;
  const VdbFile here = read_vdb(dir / "a.vdb", trusted), there = read_vdb(dir / "a.vdb");
  CHECK(there.grid.name == grid.name);
  CHECK(there.grid.transform.origin == here.grid.transform.origin);
  CHECK(there.grid.background == here.grid.background);
  CHECK(there.grid.node_min == here.grid.node_min);
  CHECK(there.grid.node_table == here.grid.node_table);
  CHECK(there.grid.values == here.grid.values);
  CHECK(there.grid.active == here.grid.active);
  CHECK(there.grid.cells == here.grid.cells);
  CHECK(there.warnings == here.warnings);
  REQUIRE(list_vdb(dir / "a.vdb").size() == 1);
  CHECK(list_vdb(dir / "a.vdb")[0].name == grid.name);
  CHECK(list_vdb(dir / "a.vdb")[0].active_samples == grid.active_sample_count());
}

TEST_CASE("a truncated file is named so, with the grid, wherever it ends") {
  const TemporaryFolder dir;
  write_vdb(dir / "a.vdb", sphere_grid(5));
  const auto size = std::filesystem::file_size(dir / "a.vdb");
  for (const auto length : {size / 1000, size / 50, size / 3, size - 1000, size - 1}) {
    CAPTURE(size, length);
    std::filesystem::resize_file(dir / "a.vdb", length);
    const auto [kind, text] = error_of(dir / "a.vdb");
    CHECK(kind == ErrorKind::bad_input);
    CHECK(text.size() <= Error::max_length);
    write_vdb(dir / "a.vdb", sphere_grid(5));
  }
  std::filesystem::resize_file(dir / "a.vdb", size - 1);
  CHECK(error_of(dir / "a.vdb").second ==
        dir / "a.vdb: grid \"surface\": the file ends early or points beyond its end (truncated or damaged)");
}

TEST_CASE("limits of memory and time end the reader with an error of that kind") {
  const TemporaryFolder dir;
  write_vdb(dir / "a.vdb", sphere_grid(60));
  VdbReadOptions options;
  options.max_memory = std::uint64_t{1} << 20; // half of what the grid needs, so that no build can read it
  CHECK(error_of(dir / "a.vdb", options).first == ErrorKind::limit);
  options = {};
  options.timeout_seconds = 0;
  CHECK(error_of(dir / "a.vdb", options).first == ErrorKind::limit);
}

TEST_CASE("whatever the reader does, the parent ends with one line of the right kind") {
  const TemporaryFolder dir;
  write_vdb(dir / "a.vdb", sphere_grid(5));
  const std::string path = dir / "a.vdb";
  const auto answer = [&](const std::string& script, const VdbReadOptions& options = {}) {
    const FakeReader fake("LEVELRAY_VDB_READER", dir, script);
    return error_of(path, options);
  };
  using Expected = std::pair<ErrorKind, std::string>;
  CHECK(
      answer("kill -SEGV $$") ==
      Expected(ErrorKind::bad_input, path + ": reader crashed (signal 11); the file is damaged or hostile"));
  CHECK(answer("exit 7") ==
        Expected(ErrorKind::bad_input, path + ": the reader ended without an answer (status 7)"));
  CHECK(answer("cat /dev/zero") ==
        Expected(ErrorKind::bad_input,
                 path + ": the reader process answered nonsense (its first bytes); the file is "
                        "damaged or hostile"));
  CHECK(answer("printf EVLREVR").first == ErrorKind::bad_input); // too short

  VdbReadOptions brief;
  brief.timeout_seconds = 0.2;
  const auto start = std::chrono::steady_clock::now();
  CHECK(answer("exec sleep 20", brief) ==
        Expected(ErrorKind::limit, path + ": reading took longer than 0.2 s and was stopped"));
  CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(5));

  ::setenv("LEVELRAY_VDB_READER", "/nonexistent/reader", 1);
  CHECK(error_of(path) ==
        Expected(ErrorKind::failed, "cannot start /nonexistent/reader: No such file or directory"));
  ::unsetenv("LEVELRAY_VDB_READER");
}
