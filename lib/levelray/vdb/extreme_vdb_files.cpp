#include "levelray/vdb/extreme_vdb_files.hpp"

#include "levelray/core/error.hpp"
#include "levelray/measure/made_grids.hpp"
#include "levelray/measure/ray_trial.hpp"
#include "levelray/vdb/to_openvdb.hpp"
#include "levelray/vdb/vdb_file.hpp"

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <limits>
#include <openvdb/openvdb.h>

namespace levelray {

namespace {

constexpr const char* file_name = "a.vdb";

// A folder of its own, gone with its files at the end.
class Folder {
 public:
  Folder() : path_((std::filesystem::temp_directory_path() / "levelray_extremes_XXXXXX").string()) {
    if (!::mkdtemp(path_.data())) throw Error(ErrorKind::failed, "cannot make a folder for temporary files");
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  std::string file() const { return path_ + "/" + file_name; }

 private:
  std::string path_;
};

BlockGrid ball(const GridTransform& transform, double band = 3) {
  return grid_of_field([](const Vec3d& p) { return ball_distance(p, Vec3d(0.2, -0.3, 0.1), 6.3); }, 8,
                       transform, band);
}

// A ball as OpenVDB's grid, for what write_vdb would not write.
openvdb::FloatGrid::Ptr openvdb_ball() {
  initialize_openvdb();
  return to_openvdb(ball({}));
}

BlockGrid written_and_read(const openvdb::FloatGrid::Ptr& grid) {
  const Folder folder;
  openvdb::io::File(folder.file()).write({grid});
  VdbReadOptions options;
  options.trust_input = true;
  return read_vdb(folder.file(), options).grid;
}

ExtremeRow refused(const char* name, const char* expected, const char* text, std::function<void()> work) {
  return {"files", name, expected, [=](const ExtremeSettings&) {
            ExtremeOutcome outcome = expect_refusal(text, work);
            // Without the folder, which has another name each time.
            const std::size_t at = outcome.detail.find(file_name);
            if (outcome.verdict == ExtremeVerdict::refused && at != std::string::npos)
              outcome.detail.erase(0, at);
            return outcome;
          }};
}

ExtremeRow with_map(const char* name, const char* expected, const char* text,
                    std::function<void(openvdb::math::Mat4d&)> change) {
  return refused(name, expected, text, [=] {
    openvdb::math::Mat4d matrix = openvdb::math::Mat4d::identity();
    change(matrix);
    const openvdb::FloatGrid::Ptr grid = openvdb_ball();
    grid->setTransform(openvdb::math::Transform::createLinearTransform(matrix));
    written_and_read(grid);
  });
}

ExtremeRow with_value(const char* name, const char* expected, float value) {
  return refused(name, expected, "a value that is not a finite 32-bit number, at sample (6, 1, -2)", [=] {
    const openvdb::FloatGrid::Ptr grid = openvdb_ball();
    grid->tree().setValue(openvdb::Coord(6, 1, -2), value);
    written_and_read(grid);
  });
}

// Written, read back in the same way as foreign files, compared sample by sample, and traced.
ExtremeRow round_trip(const char* name, const char* expected, std::function<std::vector<BlockGrid>()> grids) {
  return {"files", name, expected, [=](const ExtremeSettings& settings) {
            ExtremeTally tally("voxel");
            for (const BlockGrid& grid : grids()) {
              const Folder folder;
              write_vdb(folder.file(), grid);
              const BlockGrid back = read_vdb(folder.file()).grid;
              const auto text = [&] {
                return fmt::format("a voxel of {:a} does not come back as it was", grid.transform.voxel_size);
              };
              tally.check(back.transform.voxel_size == grid.transform.voxel_size &&
                              back.transform.origin == grid.transform.origin &&
                              back.background == grid.background,
                          text);
              const Vec3i low = grid.node_min * node_dim, size = grid.node_dims * node_dim;
              for (int k = 0; k < size.z; ++k)
                for (int j = 0; j < size.y; ++j)
                  for (int i = 0; i < size.x; ++i)
                    tally.check(back.value(low.x + i, low.y + j, low.z + k) ==
                                    grid.value(low.x + i, low.y + j, low.z + k),
                                text);
              RayTrial trial(back,
                             fmt::format("ball of voxels {:a}, from its file", grid.transform.voxel_size),
                             settings, tally);
              trial.judge_all_kinds(30);
            }
            return tally.outcome();
          }};
}

// Background 0, as some writers have it, is taken for the largest value: the surface stays where it was.
ExtremeOutcome background_0(const ExtremeSettings& settings) {
  ExtremeTally tally("voxel");
  initialize_openvdb();
  const openvdb::FloatGrid::Ptr grid = openvdb::FloatGrid::create(0);
  const auto value = [](int i, int j, int k) {
    return static_cast<float>(ball_distance(Vec3d(i, j, k), Vec3d(0.2, -0.3, 0.1), 4.3));
  };
  for (int k = -8; k <= 8; ++k)
    for (int j = -8; j <= 8; ++j)
      for (int i = -8; i <= 8; ++i) grid->tree().setValue(openvdb::Coord(i, j, k), value(i, j, k));
  grid->setGridClass(openvdb::GRID_LEVEL_SET);
  grid->setName("phi");
  const BlockGrid back = written_and_read(grid);
  tally.check(back.background > 0, [] { return std::string("the background is still 0"); });
  for (int k = -8; k <= 8; ++k)
    for (int j = -8; j <= 8; ++j)
      for (int i = -8; i <= 8; ++i)
        tally.check(back.value(i, j, k) == value(i, j, k),
                    [&] { return fmt::format("sample ({}, {}, {}) is {:a}", i, j, k, back.value(i, j, k)); });
  RayTrial trial(back, "ball, background 0 in its file", settings, tally);
  trial.judge_all_kinds(40);
  return tally.outcome();
}

// Bytes changed, cut off, repeated: read or refused, in a process of its own.
ExtremeOutcome damaged(const ExtremeSettings& settings) {
  ExtremeTally tally;
  const Folder folder;
  write_vdb(folder.file(), ball({}));
  std::ifstream file(folder.file(), std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  std::mt19937_64 random(settings.seed);
  for (int i = 0; i < 40; ++i) {
    std::string bad = bytes;
    // Most of the structure is in the first kilobytes.
    const auto place = [&] {
      return static_cast<std::size_t>(random() %
                                      (i % 2 ? bad.size() : std::min<std::size_t>(bad.size(), 2000)));
    };
    if (i % 5 == 0) bad.resize(place());
    if (i % 7 == 0 && !bad.empty()) bad.insert(place(), bad.substr(place(), 64));
    for (int k = 0; k < 1 + i % 4 && !bad.empty(); ++k) bad[place()] = static_cast<char>(random() & 0xFF);
    std::ofstream(folder.file(), std::ios::binary | std::ios::trunc) << bad;
    VdbReadOptions options;
    options.max_memory = std::uint64_t{1} << 29;
    options.timeout_seconds = 20;
    tally.add();
    try {
      const BlockGrid grid = read_vdb(folder.file(), options).grid;
      for (const float v : grid.values)
        tally.check(std::isfinite(v), [&] {
          return fmt::format("damage {} of seed {} makes a value of {}", i, settings.seed, v);
        });
    } catch (const Error& error) {
      tally.check(std::string(error.what()).find('\n') == std::string::npos,
                  [&] { return std::string("more than a line: ") + error.what(); });
    }
  }
  return tally.outcome();
}

} // namespace

std::vector<ExtremeRow> extreme_vdb_rows() {
  const auto infinite = std::numeric_limits<float>::infinity();
  return {
      refused("vdb-voxel-1e-9",
              "Voxels below 1.442e-5 cannot be written, because OpenVDB 10 takes their map for singular; "
              "tracing takes them.",
              "OpenVDB cannot represent voxels of 1e-09: the smallest are 1.442e-05; scale the mesh up",
              [] {
                const Folder folder;
                write_vdb(folder.file(), ball({Vec3d(0, 0, 0), 1e-9}));
              }),
      round_trip("vdb-voxels",
                 "Voxels of 1.45e-5, 1 and 1e9 come back from a .vdb, bit by bit, and are traced.",
                 [] {
                   return std::vector<BlockGrid>{ball({Vec3d(0, 0, 0), 1.45e-5}), ball({}),
                                                 ball({Vec3d(0, 0, 0), 1e9})};
                 }),
      round_trip("vdb-offset-1e7", "A world offset of 1e7 comes back, and is traced.",
                 [] {
                   return std::vector<BlockGrid>{ball({Vec3d(1e7 / 2 + 0.37, 1e7 - 0.11, 812.3), 0.01})};
                 }),
      round_trip("vdb-band-1-voxel", "A band of 1 voxel comes back, and is traced.",
                 [] { return std::vector<BlockGrid>{ball({}, 1)}; }),
      with_map("vdb-non-uniform", "Voxels that are no cubes are refused.", "non-uniform voxels",
               [](openvdb::math::Mat4d& m) { m(2, 2) = 2; }),
      with_map("vdb-sheared", "Sheared voxels are refused.", "sheared voxels",
               [](openvdb::math::Mat4d& m) { m(0, 1) = 0.25; }),
      with_map("vdb-rotated", "Turned voxels are refused.", "rotated voxels",
               [](openvdb::math::Mat4d& m) { m.preRotate(openvdb::math::Z_AXIS, 0.3); }),
      with_map("vdb-mirrored", "Mirrored voxels are refused.", "mirroring transform",
               [](openvdb::math::Mat4d& m) { m(0, 0) = -1; }),
      with_value("vdb-nan", "A NaN among the samples is refused, and its place told.",
                 std::numeric_limits<float>::quiet_NaN()),
      with_value("vdb-inf", "An infinite sample is refused, and its place told.", infinite),
      refused("vdb-empty", "A grid without active values is refused.", "is empty: no active values",
              [] {
                initialize_openvdb();
                const openvdb::FloatGrid::Ptr grid = openvdb::FloatGrid::create(3);
                grid->setGridClass(openvdb::GRID_LEVEL_SET);
                grid->setName("a");
                written_and_read(grid);
              }),
      refused("vdb-indices", "Samples with indices beyond 2^30 are refused.",
              "indices beyond +-1073741824 are not supported",
              [] {
                const openvdb::FloatGrid::Ptr grid = openvdb_ball();
                grid->tree().setValue(openvdb::Coord(2147483000, 0, 0), -1.0f);
                written_and_read(grid);
              }),
      {"files", "vdb-background-0", "A background of 0 is taken for the largest value: the surface stays.",
       background_0},
      {"files", "vdb-damaged",
       "Damaged .vdb files are read or refused by one line, in a process with limits.", damaged},
  };
}

} // namespace levelray
