// Conversion against brute force: every sample of the band, on real meshes.
#include "levelray/core/error.hpp"
#include "levelray/core/parallel.hpp"
#include "levelray/io/mesh_reader.hpp"
#include "support/catch.hpp"
#include "support/conversion.hpp"

#include <atomic>
#include <filesystem>
#include <mutex>
#include <random>

using namespace levelray;
using namespace levelray::test;

namespace {

const std::filesystem::path testdata = LEVELRAY_TESTDATA;

bool have_testdata() {
  if (std::filesystem::is_directory(testdata / "classic")) return true;
  WARN("not tested: no test data at " << testdata.string());
  return false;
}

ConvertedGrid convert_at(const PreparedMesh& mesh, int resolution) {
  ConvertOptions options;
  options.resolution = resolution;
  return mesh_to_grid(mesh, options);
}

struct Wrong {
  std::uint64_t samples = 0, distances = 0, missing = 0, signs = 0;
  double worst_voxels = 0;
};

// Every stored sample, in parallel over nodes: distance by the tree of triangles in double (the same as
// looking at each: tested in unit/closest_point), sign by `inside`.
template <class Inside>
Wrong check_samples(const BlockGrid& grid, const TriangleBvh& bvh, Inside&& inside) {
  Wrong total;
  std::mutex mutex;
  parallel_for(grid.nodes.size(), 8, [&](std::size_t begin, std::size_t end) {
    Wrong wrong;
    for (std::size_t n = begin; n < end; ++n)
      for (int bit = 0; bit < 64; ++bit) {
        const BlockGrid::Node& node = grid.nodes[n];
        if (!(node.stored >> bit & 1)) continue;
        const std::size_t block = BlockGrid::block_index(node, bit);
        const Vec3i corner = node.coord * node_dim + Vec3i(bit_x(bit), bit_y(bit), bit_z(bit)) * block_dim;
        for (int s = 0; s < samples_per_block; ++s) {
          const float value = grid.values[block * samples_per_block + static_cast<std::size_t>(s)];
          const bool active = grid.active[block] >> s & 1;
          const Vec3d p =
              grid.transform.to_world(Vec3d(corner.x + bit_x(s), corner.y + bit_y(s), corner.z + bit_z(s)));
          const auto nearest = bvh.closest_point(p, double{grid.background} * 1.001);
          const double distance = nearest ? std::sqrt(nearest->distance_squared) : 2.0 * grid.background;
          const double bound = distance_bound(grid, distance);
          ++wrong.samples;
          if (active) {
            const double error = std::abs(std::abs(double{value}) - distance);
            wrong.worst_voxels = std::max(wrong.worst_voxels, error / grid.transform.voxel_size);
            wrong.distances += !(error <= bound);
          } else {
            wrong.missing += distance < grid.background - bound;
          }
          if (distance > bound) wrong.signs += inside(p) != std::signbit(value);
        }
      }
    const std::lock_guard lock(mutex);
    total.samples += wrong.samples;
    total.distances += wrong.distances;
    total.missing += wrong.missing;
    total.signs += wrong.signs;
    total.worst_voxels = std::max(total.worst_voxels, wrong.worst_voxels);
  });
  return total;
}

} // namespace

TEST_CASE("every band sample of ten meshes holds its exact distance") {
  if (!have_testdata()) return;
  for (const char* name :
       {"classic/stanford-bunny-closed.obj", "classic/stanford-bunny.obj",
        "classic/stanford-dragon-80k-closed.obj", "classic/happy-buddha-100k.obj",
        "classic/armadillo-86k.obj", "classic/igea-tristrips.ply", "classic/spot.obj", "classic/cow.obj",
        "classic/teapot.obj", "classic/suzanne.obj", "classic/dragon_vrip_res2.ply"}) {
    CAPTURE(name);
    const PreparedMesh mesh = prepare_mesh(read_mesh((testdata / name).string()).mesh);
    const BlockGrid grid = convert_at(mesh, 100).grid;
    const TriangleBvh bvh(mesh.mesh);
    const Wrong wrong = check_samples(grid, bvh, [](const Vec3d&) { return false; });
    CHECK(wrong.samples > 100000);
    CHECK(wrong.distances == 0);
    CHECK(wrong.missing == 0);

    // The tree itself, by looking at every triangle for a few samples.
    std::mt19937_64 rng(3);
    for (int i = 0; i < 20; ++i) {
      const BlockGrid::Node& node = grid.nodes[rng() % grid.nodes.size()];
      const int bit = std::countr_zero(node.stored);
      const Vec3i corner = node.coord * node_dim + Vec3i(bit_x(bit), bit_y(bit), bit_z(bit)) * block_dim;
      const Vec3d p = grid.transform.to_world(Vec3d(corner.x, corner.y, corner.z));
      const double distance = std::sqrt(closest_point_brute_force(mesh.mesh, p).distance_squared);
      const double value = std::abs(double{grid.value(corner.x, corner.y, corner.z)});
      CHECK(std::abs(value - std::min(distance, double{grid.background})) <= distance_bound(grid, distance));
    }
  }
}

TEST_CASE("the sign is the exact winding number's on every closed mesh, at every sample") {
  if (!have_testdata()) return;
  int closed = 0;
  for (const char* folder : {"classic", "hard"})
    for (const auto& entry : std::filesystem::directory_iterator(testdata / folder)) {
      if (entry.path().extension() == ".gz") continue;
      const PreparedMesh mesh = prepare_mesh(read_mesh(entry.path().string()).mesh);
      if (!mesh.open_edges.empty()) continue;
      CAPTURE(entry.path().filename().string());
      ++closed;
      const BlockGrid grid = convert_at(mesh, 80).grid;
      const TriangleBvh bvh(mesh.mesh);
      const Wrong wrong = check_samples(
          grid, bvh, [&](const Vec3d& p) { return winding_by_ray(bvh, p, Vec3d(0.137, 0.291, 1)) > 0; });
      CHECK(wrong.signs == 0);
      CHECK(wrong.distances == 0);

      // The rays themselves, by the sum of all solid angles for a few samples.
      std::mt19937_64 rng(5);
      for (int i = 0; i < 20; ++i) {
        const BlockGrid::Node& node = grid.nodes[rng() % grid.nodes.size()];
        const Vec3i sample =
            node.coord * node_dim +
            Vec3i(static_cast<int>(rng() % 16), static_cast<int>(rng() % 16), static_cast<int>(rng() % 16));
        const Vec3d p = grid.transform.to_world(Vec3d(sample.x, sample.y, sample.z));
        const auto nearest = bvh.closest_point(p, grid.transform.voxel_size * 1e-3);
        if (!nearest)
          CHECK((winding_number(mesh.mesh, p) > 0.5) ==
                std::signbit(grid.value(sample.x, sample.y, sample.z)));
      }
    }
  CHECK(closed >= 30);
}

TEST_CASE("the sign of open meshes is the generalised winding number's") {
  if (!have_testdata()) return;
  for (const char* name :
       {"classic/stanford-bunny.obj", "classic/teapot.obj", "classic/suzanne.obj", "hard/cgal-open_cube.off",
        "hard/igl-truck.obj", "hard/cgal-elephant-with-holes.off", "hard/gc-moebius.obj"}) {
    CAPTURE(name);
    const PreparedMesh mesh = prepare_mesh(read_mesh((testdata / name).string()).mesh);
    const BlockGrid grid = convert_at(mesh, 64).grid;
    const TriangleBvh bvh(mesh.mesh);
    std::mt19937_64 rng(11);
    int wrong = 0, inside = 0, compared = 0;
    for (int i = 0; i < 1500; ++i) {
      const BlockGrid::Node& node = grid.nodes[rng() % grid.nodes.size()];
      const Vec3i sample =
          node.coord * node_dim +
          Vec3i(static_cast<int>(rng() % 16), static_cast<int>(rng() % 16), static_cast<int>(rng() % 16));
      const Vec3d p = grid.transform.to_world(Vec3d(sample.x, sample.y, sample.z));
      const double w = winding_number(mesh.mesh, p);
      // Samples on the surface or on the isosurface w = 1/2 itself have no side.
      if (std::abs(w - 0.5) < 1e-6 || bvh.closest_point(p, grid.transform.voxel_size * 2e-5)) continue;
      ++compared;
      inside += w > 0.5;
      wrong += (w > 0.5) != std::signbit(grid.value(sample.x, sample.y, sample.z));
    }
    CHECK(wrong == 0);
    CHECK(compared > 1000);
    CHECK(inside > 10);
  }
}
