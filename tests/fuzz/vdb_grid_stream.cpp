// What a reader process that was taken over could send: the parent must take sound grids only, and little
// memory.
#include "levelray/core/error.hpp"
#include "levelray/grid/complete_blocks.hpp"
#include "levelray/vdb/grid_stream.hpp"
#include "levelray/vdb/level_set_check.hpp"
#include "support/catch.hpp"
#include "support/sphere_grid.hpp"

#include <cstring>
#include <random>

using namespace levelray;
using namespace levelray::test;

namespace {

struct Ended {};

VdbFile receive(const std::string& bytes, std::uint64_t max_bytes) {
  std::size_t at = 0;
  const ByteSource source = [&](void* to, std::size_t count) {
    if (count > bytes.size() - at) throw Ended();
    std::memcpy(to, bytes.data() + at, count);
    at += count;
  };
  return receive_file(source, "x.vdb", max_bytes, /*with_grid=*/true);
}

} // namespace

TEST_CASE("20000 damaged answers of the reader process give a sound grid or an error") {
  VdbFile file;
  file.grid = sphere_grid(3, 1.5);
  file.grids.resize(2);
  file.grids[1].name = "surface";
  file.warnings = {"first", "second"};
  std::string good;
  send_file([&](const void* bytes, std::size_t n) { good.append(static_cast<const char*>(bytes), n); }, file,
            true);
  const VdbFile back = receive(good, 1 << 20);
  REQUIRE(back.grid.values == file.grid.values);
  REQUIRE(back.warnings == file.warnings);

  constexpr std::uint64_t seed = 5;
  std::mt19937_64 random(seed);
  constexpr std::uint64_t max_bytes = 1 << 22;
  static const std::uint64_t odd[] = {
      0, 1, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFF, 0x7FF0000000000000, ~std::uint64_t{0}, 1u << 24};
  // Offsets of the counts: everything before the node table, found from the end.
  const std::size_t tail =
      file.grid.node_table.size() * 4 + file.grid.nodes.size() * 16 + file.grid.block_count() * 264 + 8;
  const std::size_t head = good.size() - tail;
  int sound = 0, refused = 0;
  for (int round = 0; round < 20000; ++round) {
    CAPTURE(seed, round);
    std::string bytes = good;
    for (std::uint64_t changes = 1 + random() % 3; changes; --changes) {
      const std::size_t range = random() % 2 ? head : head + (random() % 2 ? tail / 8 : tail);
      const std::size_t at = static_cast<std::size_t>(random() % range);
      if (random() % 2) {
        bytes[at] = static_cast<char>(bytes[at] ^ (1 << random() % 8));
      } else {
        const std::uint64_t v = odd[random() % std::size(odd)];
        std::memcpy(&bytes[at], &v, std::min<std::size_t>(random() % 2 ? 4 : 8, bytes.size() - at));
      }
    }
    try {
      VdbFile got = receive(bytes, max_bytes);
      REQUIRE(got.grid.bytes() <= max_bytes * 2);
      try {
        complete_blocks(got.grid, max_bytes * 4);
        level_set_remarks(got.grid, field_facts(got.grid));
      } catch (const Error& error) {
        REQUIRE(error.kind() == ErrorKind::limit);
      }
      ++sound;
    } catch (const Error& error) {
      REQUIRE(std::string(error.what()).size() <= Error::max_length);
      ++refused;
    } catch (const Ended&) {
      ++refused;
    }
  }
  CHECK(sound > 1000);
  CHECK(refused > 1000);
}
