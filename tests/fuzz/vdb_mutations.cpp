// Damaged OpenVDB files through the limited reader: whatever happens there, the parent gets a sound grid or
// one line.
#include "levelray/core/error.hpp"
#include "levelray/vdb/vdb_file.hpp"
#include "support/catch.hpp"
#include "support/sphere_grid.hpp"
#include "support/temporary_folder.hpp"

#include <chrono>
#include <cstring>
#include <fstream>
#include <map>
#include <openvdb/openvdb.h>
#include <random>
#include <sstream>

using namespace levelray;
using namespace levelray::test;

namespace {

std::string bytes_of(const std::string& path) {
  std::ostringstream out;
  out << std::ifstream(path, std::ios::binary).rdbuf();
  return out.str();
}

// Small files that pass through different parts of OpenVDB's reader: masks alone, 16-bit floats, zip, no
// compression with doubles, several grids of which one shares a tree.
std::vector<std::string> seeds(const TemporaryFolder& dir) {
  const std::string path = dir / "seed.vdb";
  std::vector<std::string> files;
  const BlockGrid ball = sphere_grid(10);
  VdbWriteOptions options;
  for (const bool half : {false, true}) {
    options.half = half;
    write_vdb(path, ball, options);
    files.push_back(bytes_of(path));
  }
  openvdb::initialize();
  openvdb::io::File source(path);
  source.open(/*delayLoad=*/false);
  const auto floats = openvdb::gridPtrCast<openvdb::FloatGrid>(source.readGrid("surface"));
  source.close();
  for (const std::uint32_t compression : {openvdb::io::COMPRESS_ZIP | openvdb::io::COMPRESS_ACTIVE_MASK,
                                          openvdb::io::COMPRESS_BLOSC | openvdb::io::COMPRESS_ACTIVE_MASK}) {
    openvdb::FloatGrid::Ptr classless = floats->deepCopy();
    classless->setGridClass(openvdb::GRID_UNKNOWN); // level sets are never zipped
    openvdb::io::File out(path);
    out.setCompression(compression);
    out.write(openvdb::GridPtrVec{classless});
    files.push_back(bytes_of(path));
  }
  const auto doubles = std::make_shared<openvdb::DoubleGrid>(*floats);
  openvdb::FloatGrid::Ptr shared = openvdb::FloatGrid::create(floats->treePtr());
  shared->setName("shared");
  openvdb::io::File out(path);
  out.setCompression(openvdb::io::COMPRESS_NONE);
  out.write(openvdb::GridPtrVec{floats, doubles, shared});
  files.push_back(bytes_of(path));
  return files;
}

using Random = std::mt19937_64;

std::string mutate(std::string bytes, Random& random) {
  const auto below = [&](std::size_t n) { return static_cast<std::size_t>(random() % n); };
  // Values fill most of a file and rarely matter: half of the changes go to the first 2 KiB, where counts and
  // offsets are.
  const auto place = [&] {
    return below(random() % 2 ? std::min<std::size_t>(bytes.size(), 2048) : bytes.size());
  };
  static const std::uint64_t odd[] = {
      0, 1, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFF, 0x7FF0000000000000, 0xFFFFFFFFFFFFFFFF, 1u << 20, 0x7FC00000};
  for (std::size_t changes = 1 + below(4); changes; --changes) {
    const std::size_t at = place();
    switch (random() % 6) {
    case 0:
      bytes[at] = static_cast<char>(bytes[at] ^ (1 << below(8)));
      break;
    case 1:
      bytes[at] = static_cast<char>(random());
      break;
    case 2: { // an odd number
      const std::uint64_t v = odd[below(std::size(odd))];
      const std::size_t length = random() % 2 ? 4 : 8;
      std::memcpy(&bytes[at], &v, std::min(length, bytes.size() - at));
      break;
    }
    case 3: { // a piece from elsewhere
      const std::size_t from = place(), length = 1 + below(64);
      bytes.replace(at, std::min(length, bytes.size() - at), bytes.substr(from, length));
      break;
    }
    case 4:
      bytes.erase(at, 1 + below(16));
      break;
    default:
      if (random() % 4 == 0) bytes.resize(std::max<std::size_t>(at, 1));
      break;
    }
    if (bytes.size() < 8) break;
  }
  return bytes;
}

} // namespace

TEST_CASE("2000 damaged OpenVDB files give a sound grid or one line, and nothing else") {
  const TemporaryFolder dir;
  const std::string path = dir / "a.vdb";
  const std::vector<std::string> files = seeds(dir);
  constexpr std::uint64_t seed = 20261;
  Random random(seed);
  VdbReadOptions options;
  options.max_memory = std::uint64_t{128} << 20;
  options.timeout_seconds = 5;

  std::map<std::string, int> outcomes;
  for (int round = 0; round < 2000; ++round) {
    CAPTURE(seed, round);
    const std::string bytes = mutate(files[static_cast<std::size_t>(round) % files.size()], random);
    std::ofstream(path, std::ios::binary) << bytes;
    options.grid = random() % 4 ? "" : "[0]";
    const auto start = std::chrono::steady_clock::now();
    try {
      const VdbFile file = read_vdb(path, options);
      ++outcomes["read"];
      REQUIRE(file.grid.active_sample_count() > 0);
      REQUIRE(file.grid.cells.size() == file.grid.block_count());
      REQUIRE(file.grid.bytes() < options.max_memory * 2);
      for (const std::string& warning : file.warnings) REQUIRE(warning.size() < 500);
    } catch (const Error& error) {
      const std::string text = error.what();
      CAPTURE(text);
      REQUIRE((error.kind() == ErrorKind::bad_input || error.kind() == ErrorKind::limit));
      REQUIRE(text.size() <= Error::max_length);
      REQUIRE(text.rfind(path, 0) == 0);
      ++outcomes[text.find("crashed") != std::string::npos    ? "crashed"
                 : text.find("nonsense") != std::string::npos ? "nonsense"
                 : error.kind() == ErrorKind::limit           ? "limit"
                                                              : "refused"];
    }
    // The timeout and some seconds for a loaded machine.
    REQUIRE(std::chrono::steady_clock::now() - start < std::chrono::seconds(30));
  }
  std::string summary;
  for (const auto& [outcome, count] : outcomes) summary += " " + outcome + " " + std::to_string(count);
  WARN("outcomes:" << summary);
  CHECK(outcomes["read"] > 100); // or the mutations break everything and test little
  CHECK(outcomes["refused"] > 100);
}
