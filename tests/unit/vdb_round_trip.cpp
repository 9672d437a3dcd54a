#include "levelray/core/error.hpp"
#include "levelray/core/parallel.hpp"
#include "levelray/vdb/vdb_file.hpp"
#include "support/catch.hpp"
#include "support/sphere_grid.hpp"
#include "support/temporary_folder.hpp"

#include <cstring>
#include <fstream>
#include <random>
#include <sstream>

using namespace levelray;
using namespace levelray::test;

namespace {

VdbReadOptions trusted() {
  VdbReadOptions options;
  options.trust_input = true;
  return options;
}

std::string bytes_of(const std::string& path) {
  std::ostringstream out;
  out << std::ifstream(path, std::ios::binary).rdbuf();
  return out.str();
}

// Compares every sample and its active bit over both tables and a margin, bit by bit.
void require_same_samples(const BlockGrid& a, const BlockGrid& b) {
  Vec3i low, high;
  for (int i = 0; i < 3; ++i) {
    low[i] = std::min(a.node_min[i], b.node_min[i]) * node_dim - 3;
    high[i] = std::max(a.node_min[i] + a.node_dims[i], b.node_min[i] + b.node_dims[i]) * node_dim + 3;
  }
  const auto active = [](const BlockGrid& g, int i, int j, int k) {
    const float* block = g.find_block(i, j, k);
    if (!block) return false;
    const std::size_t index = static_cast<std::size_t>(block - g.values.data()) / samples_per_block;
    return (g.active[index] >> bit_in_block(i, j, k) & 1) != 0;
  };
  std::size_t different = 0;
  for (int k = low.z; k < high.z; ++k)
    for (int j = low.y; j < high.y; ++j)
      for (int i = low.x; i < high.x; ++i) {
        const float u = a.value(i, j, k), v = b.value(i, j, k);
        different += std::memcmp(&u, &v, sizeof u) != 0 || active(a, i, j, k) != active(b, i, j, k);
      }
  CHECK(different == 0);
}

void require_same_grid(const BlockGrid& a, const BlockGrid& b) {
  CHECK(a.background == b.background);
  CHECK(a.transform.voxel_size == b.transform.voxel_size);
  CHECK(a.transform.origin == b.transform.origin);
  CHECK(a.name == b.name);
  CHECK(a.active_sample_count() == b.active_sample_count());
  require_same_samples(a, b);
}

} // namespace

TEST_CASE("a level set survives the way through an OpenVDB file bit by bit") {
  const TemporaryFolder dir;
  BlockGrid grid = sphere_grid(40, 3, 0.1); // holds inside nodes
  REQUIRE(std::count(grid.node_table.begin(), grid.node_table.end(), BlockGrid::inside_node) > 0);
  SECTION("at the origin") {}
  SECTION("translated") {
    grid.transform.origin = Vec3d(1000.25, -3e-3, 7);
    grid.name = "dragon";
  }
  SECTION("with an odd voxel size") {
    grid.transform.voxel_size = 0.1 / 3;
  }
  write_vdb(dir / "a.vdb", grid);
  const VdbFile file = read_vdb(dir / "a.vdb", trusted());
  require_same_grid(grid, file.grid);
  CHECK(file.grid.cells.size() == file.grid.block_count());
  CHECK(file.grid.block_count() == grid.block_count());
  REQUIRE(file.grids.size() == 1);
  CHECK(file.grids[0].grid_class == "level set");
  CHECK(file.grids[0].type == "float");
  CHECK(file.grids[0].active_samples == grid.active_sample_count());
}

TEST_CASE("stored blocks with inactive samples of both signs survive") {
  const TemporaryFolder dir;
  const BlockGrid grid = sphere_grid(21, 0.4);
  std::size_t without_band = 0;
  for (const std::uint64_t mask : grid.active) without_band += mask == 0;
  REQUIRE(without_band > 0);
  write_vdb(dir / "a.vdb", grid);
  const VdbFile file = read_vdb(dir / "a.vdb", trusted());
  require_same_grid(grid, file.grid);
  CHECK(file.grid.block_count() == grid.block_count());
  CHECK(file.grid.cells.size() == grid.cells.size());
}

TEST_CASE("random blocks of random values survive, at negative indices too") {
  const TemporaryFolder dir;
  std::mt19937 random(7);
  INFO("seed 7");
  BlockGrid grid;
  grid.background = 2.5f;
  grid.node_min = Vec3i(-3, -1, -2);
  grid.node_dims = Vec3i(5, 3, 4);
  for (int n = 0; n < 60; ++n) {
    if (random() % 3 == 0) {
      grid.node_table.push_back(random() % 2 ? BlockGrid::inside_node : BlockGrid::outside_node);
      continue;
    }
    BlockGrid::Node node;
    node.coord = grid.node_min + Vec3i(n % 5, n / 5 % 3, n / 15);
    node.stored = std::uint64_t{random()} << 32 | random();
    node.inside = (std::uint64_t{random()} << 32 | random()) & ~node.stored;
    node.first_block = grid.active.size();
    for (int b = 0; b < std::popcount(node.stored); ++b) {
      const std::uint64_t active = std::uint64_t{random()} << 32 | random();
      for (int s = 0; s < samples_per_block; ++s) {
        const float v = std::uniform_real_distribution<float>(-2.5f, 2.5f)(random);
        grid.values.push_back(active >> s & 1 ? v : v < 0 ? -grid.background : grid.background);
      }
      grid.active.push_back(active);
    }
    grid.node_table.push_back(static_cast<std::uint32_t>(grid.nodes.size()));
    grid.nodes.push_back(node);
  }
  write_vdb(dir / "a.vdb", grid);
  require_same_grid(grid, read_vdb(dir / "a.vdb", trusted()).grid);
}

TEST_CASE("a solid of 2 x 128^3 samples and more becomes tiles, and comes back") {
  const TemporaryFolder dir;
  const Box3d box(Vec3d(-150, -140, -5), Vec3d(160, 150, 300)); // of three different extents
  const auto field = [&](const Vec3d& p) {
    double d = -1e9;
    for (int a = 0; a < 3; ++a) d = std::max({d, box.min[a] - p[a], p[a] - box.max[a]});
    return d;
  };
  const BlockGrid grid = sample_grid(field, 1, 3, Box3d(box.min - Vec3d(5, 5, 5), box.max + Vec3d(5, 5, 5)));
  write_vdb(dir / "a.vdb", grid);
  require_same_grid(grid, read_vdb(dir / "a.vdb", trusted()).grid);
}

TEST_CASE("half floats lose at most 2^-11 of a value") {
  const TemporaryFolder dir;
  const BlockGrid grid = sphere_grid(15, 3, 0.1);
  VdbWriteOptions options;
  options.half = true;
  write_vdb(dir / "a.vdb", grid, options);
  const VdbFile file = read_vdb(dir / "a.vdb", trusted());
  CHECK(file.grid.active_sample_count() == grid.active_sample_count());
  CHECK(file.grid.background == Approx(grid.background).epsilon(0.0005));
  // Rounding to 11 significant bits: 2^-11 relative for normal numbers, half of 2^-24 below them (IEEE 754
  // binary16).
  std::size_t off = 0;
  for (int k = -64; k < 64; ++k)
    for (int j = -64; j < 64; ++j)
      for (int i = -64; i < 64; ++i) {
        const float exact = grid.value(i, j, k);
        off += std::fabs(file.grid.value(i, j, k) - exact) > std::max(std::fabs(exact) * 0x1p-11f, 0x1p-25f);
      }
  CHECK(off == 0);
}

TEST_CASE("the same grid gives the same bytes, for any number of threads, and others give others") {
  const TemporaryFolder dir;
  const BlockGrid grid = sphere_grid(70, 3, 0.25);
  std::string first;
  for (const int threads : {1, 1, 2, 7}) {
    const ThreadLimit limit(threads);
    write_vdb(dir / "a.vdb", grid);
    const std::string bytes = bytes_of(dir / "a.vdb");
    REQUIRE(bytes.size() > 1000);
    if (first.empty()) first = bytes;
    CHECK(bytes == first);
  }
  BlockGrid other = grid;
  other.values[1234] += 1e-3f;
  write_vdb(dir / "b.vdb", other);
  const std::string bytes = bytes_of(dir / "b.vdb");
  CHECK(bytes.size() == first.size());
  CHECK(bytes.substr(21, 36) != first.substr(21, 36)); // the file's identifier
  CHECK(first[21 + 14] == '8');                        // its version, RFC 9562
}
