// `exact` against a reference in long double: no hit lost, none invented, and the same t.
//
// LEVELRAY_REFERENCE_RAYS sets the number of rays over all shapes (default 400,000; the full run is 10
// million).
#include "levelray/convert/mesh_to_grid.hpp"
#include "levelray/core/parallel.hpp"
#include "levelray/io/mesh_reader.hpp"
#include "levelray/measure/study_scene.hpp"
#include "levelray/trace/level_set.hpp"
#include "support/catch.hpp"
#include "support/reference_tracer.hpp"
#include "support/trace_fixtures.hpp"

#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <mutex>
#include <optional>

using namespace levelray;
using namespace levelray::test;

namespace {

// What an answer in double may differ by, in units of value. The library computes the interpolant within 16 *
// 2^-53 of the largest corner (intersect/bernstein.hpp), here 3; and the ray's points within 2^-51 of the
// distance from their box, below 2^9 voxels with slopes of at most sqrt(3) (samples of distances) times 3
// axes. Together below 10^-12; the gyroid's slope may be twice that.
constexpr double doubt = 4e-12;

struct Tally {
  std::atomic<std::uint64_t> rays{0}, hits{0}, lost{0}, invented{0}, wrong_surface{0}, in_doubt{0},
      unequal_any{0}, unproven{0};
  std::mutex mutex;
  double largest_error = 0; // |dt| in voxels, of those up to 10^-6

  void error(double e) {
    const std::lock_guard lock(mutex);
    largest_error = std::max(largest_error, e);
  }
};

WorldRay cut(WorldRay ray, double t_max) {
  ray.t_max = t_max;
  return ray;
}

void check_ray(const LevelSet& level_set, const ReferenceTracer& reference, const WorldRay& ray,
               Tally& tally) {
  const ReferenceHit expected = reference.closest(ray);
  const Hit hit = closest_hit(level_set, ray);
  ++tally.rays;
  tally.hits += expected.hit;
  tally.unequal_any += any_hit(level_set, ray) != bool(hit);
  if (expected.hit != bool(hit)) {
    if (std::fabs(expected.closest) <= doubt)
      ++tally.in_doubt;
    else
      ++(expected.hit ? tally.lost : tally.invented);
    return;
  }
  if (!hit) return;
  const double t = static_cast<double>(expected.t), difference = std::fabs(hit.t - t);
  if (difference <= 1e-6) {
    tally.error(difference);
  } else {
    // The later of the two passed what must have been a touch within doubt: on the way to just before a hit
    // that is too late nothing goes deeper than that, and up to just after one that is too early something
    // comes as near.
    const double depth =
        static_cast<double>(reference.closest(cut(ray, hit.t + (hit.t > t ? -1e-6 : 1e-6))).closest);
    ++((hit.t > t ? -depth : depth) <= doubt ? tally.in_doubt : tally.wrong_surface);
  }
  // Up to t_outside the ray stays on its side, but for touches in doubt.
  if (hit.t_outside > hit.t || reference.closest(cut(ray, hit.t_outside)).closest < -doubt) ++tally.unproven;
}

// The Stanford bunny, 128 voxels of size 1 along its longest side: as large as the other shapes.
std::optional<BlockGrid> bunny_grid() {
  const std::filesystem::path path =
      std::filesystem::path(LEVELRAY_TESTDATA) / "classic/stanford-bunny-closed.obj";
  if (!std::filesystem::exists(path)) {
    WARN("the bunny is not tested: no test data at " << path.string());
    return std::nullopt;
  }
  TriangleMesh mesh = centred_unit_mesh(read_mesh(path.string()).mesh);
  for (Vec3d& v : mesh.vertices) v *= 128;
  ConvertOptions options;
  options.voxel_size = 1;
  return mesh_to_grid(prepare_mesh(mesh), options).grid;
}

std::uint64_t ray_count() {
  const char* text = std::getenv("LEVELRAY_REFERENCE_RAYS");
  return text ? std::strtoull(text, nullptr, 10) : 400000;
}

} // namespace

TEST_CASE("exact loses no hit and invents none against a reference in long double") {
  std::vector<Shape> shapes{{"sphere of radius 20", sphere_grid(20)},
                            {"torus with a tube of radius 1", torus_grid(18, 1)},
                            {"tilted plate 0.8 voxel thick", slab_grid(0.8)},
                            {"gyroid", gyroid_grid()}};
  if (std::optional<BlockGrid> bunny = bunny_grid()) shapes.push_back({"bunny", std::move(*bunny)});
  const std::uint64_t per_shape = ray_count() / shapes.size();
  for (const Shape& shape : shapes) {
    const LevelSet level_set(shape.grid);
    const ReferenceTracer reference(shape.grid);
    const Box3d box = active_box(shape.grid);
    Tally tally;
    parallel_for(per_shape, 1000, [&](std::size_t begin, std::size_t end) {
      RandomRays random(static_cast<unsigned>(begin) + 17);
      for (std::size_t i = begin; i < end; ++i) {
        WorldRay ray = random.through(box);
        // Every eighth begins somewhere in the box, on either side.
        if (i % 8 == 0) ray.origin = random.in_box(box);
        check_ray(level_set, reference, ray, tally);
      }
    });
    CAPTURE(shape.name, tally.rays.load(), tally.hits.load(), tally.in_doubt.load(), tally.largest_error);
    CHECK(tally.lost == 0);
    CHECK(tally.invented == 0);
    CHECK(tally.wrong_surface == 0);
    CHECK(tally.unequal_any == 0);
    CHECK(tally.unproven == 0);
    // Doubtful touches need an extremum of f along the ray within 4 * 10^-12 of 0, of values spread over
    // voxels.
    CHECK(tally.in_doubt <= 1);
    CHECK(tally.hits > per_shape / 50);
    if (std::getenv("LEVELRAY_REFERENCE_RAYS"))
      WARN(shape.name << ": " << tally.rays << " rays, " << tally.hits << " hits, " << tally.lost << " lost, "
                      << tally.invented << " invented, " << tally.in_doubt << " in doubt, largest |dt| "
                      << tally.largest_error << " voxel");
  }
}
