#include "bench/trace_contest.hpp"

#include "levelray/accel/minmax_buffer.hpp"
#include "levelray/convert/mesh_to_grid.hpp"
#include "levelray/core/parallel.hpp"
#include "levelray/measure/study_scene.hpp"
#include "levelray/trace/level_set.hpp"
#include "levelray/vdb/peer.hpp"
#ifdef LEVELRAY_EMBREE
#include "support/embree_scene.hpp"
#endif

#include <array>
#include <cmath>
#include <fmt/format.h>
#include <memory>
#include <numbers>
#include <optional>
#include <stdexcept>

namespace levelray::bench {

namespace {

constexpr std::size_t tile_rays = 1024; // a 32x32 tile
constexpr int buffer_cells = 128;       // the program's default

struct Agreement {
  std::size_t hits = 0, only_ours = 0, only_theirs = 0;
  std::vector<double> errors; // |t difference| of common hits, in voxels, ascending
  double degrees = 0;         // between the normals of common hits, mean

  double quantile(double q) const {
    return errors.empty() ? 0 : errors[static_cast<std::size_t>(q * static_cast<double>(errors.size() - 1))];
  }
  std::size_t disagreements() const { return only_ours + only_theirs; }
  nlohmann::json json() const {
    return {{"hits", hits},
            {"only_levelray", only_ours},
            {"only_other", only_theirs},
            {"mean_degrees_between_normals", degrees},
            {"t_difference_voxels",
             {{"median", quantile(0.5)},
              {"p99", quantile(0.99)},
              {"p999", quantile(0.999)},
              {"max", quantile(1)}}}};
  }
};

template <class TheirHit>
Agreement agreement(const std::vector<PeerHit>& ours, const std::vector<TheirHit>& theirs, double voxel) {
  Agreement result;
  for (std::size_t i = 0; i < ours.size(); ++i) {
    result.hits += ours[i].hit;
    result.only_ours += ours[i].hit && !theirs[i].hit;
    result.only_theirs += !ours[i].hit && theirs[i].hit;
    if (!ours[i].hit || !theirs[i].hit) continue;
    result.errors.push_back(std::fabs(ours[i].t - static_cast<double>(theirs[i].t)) / voxel);
    const Vec3d n = Vec3d(theirs[i].normal).normalized();
    result.degrees +=
        std::atan2(n.cross(ours[i].normal).length(), n.dot(ours[i].normal)) * 180 / std::numbers::pi;
  }
  if (!result.errors.empty()) result.degrees /= static_cast<double>(result.errors.size());
  std::sort(result.errors.begin(), result.errors.end());
  return result;
}

void print(const char* name, const Agreement& a, std::size_t rays) {
  fmt::print("  against {}: {} of {} rays hit, {} only levelray's, {} only theirs; |t difference| in voxels: "
             "median {:.2g}, "
             "p99 {:.2g}, p99.9 {:.2g}, max {:.2g}; normals {:.2g} degrees apart\n",
             name, a.hits, rays, a.only_ours, a.only_theirs, a.quantile(0.5), a.quantile(0.99),
             a.quantile(0.999), a.quantile(1), a.degrees);
}

} // namespace

bool has_embree() {
#ifdef LEVELRAY_EMBREE
  return true;
#else
  return false;
#endif
}

nlohmann::json trace_contest(const TriangleMesh& mesh, const TraceSetup& setup) {
  fmt::print("primary rays, N = {}, {}x{}, {}, {}, {} thread{}, {} repetitions\n", setup.resolution,
             setup.image_size, setup.image_size, setup.intersector, setup.normals, setup.threads,
             setup.threads > 1 ? "s" : "", setup.repetitions);
  ConvertOptions options;
  options.resolution = setup.resolution;
  const BlockGrid grid = mesh_to_grid(prepare_mesh(mesh), options).grid;
  const double voxel = grid.transform.voxel_size;
  const Camera camera = study_camera(setup.image_size);
  const auto pixels = tiled_pixels(setup.image_size);
  const std::vector<WorldRay> rays = study_rays(setup.image_size);
  PinholeView view{camera.settings().eye, camera.right(), camera.up(), camera.forward()};
  view.half_width = view.half_height = camera.half_height();
  const LevelSet level_set(grid);
  const OpenVdbLevelSet peer = OpenVdbLevelSet::from_grid(grid);

  std::vector<PeerHit> hits(rays.size()), peer_hits(rays.size());
  const auto by_tiles = [&](const auto& work) {
    const Stopwatch watch;
    parallel_for(rays.size(), tile_rays,
                 [&](std::size_t begin, std::size_t end) { work(begin, end - begin); });
    return watch.elapsed();
  };
  std::vector<Contestant> contestants;
  // A tile at a time, of which t and normal are kept; with the bounds of a min/max buffer, or without.
  const auto trace_with = [&](const std::string& scheme, const MinMaxBuffer* buffer) {
    return by_tiles([&](std::size_t begin, std::size_t n) {
      std::array<RayBounds, tile_rays> bounds;
      PrimaryOptions primary;
      primary.intersector = setup.intersector;
      if (buffer) {
        for (std::size_t i = 0; i < n; ++i)
          bounds[i] =
              buffer->at(pixels[begin + i][0] / setup.image_size, pixels[begin + i][1] / setup.image_size);
        primary.bounds = {bounds.data(), n};
      }
      std::array<Hit, tile_rays> tile_hits;
      std::array<Vec3f, tile_rays> normals;
      const std::span<const WorldRay> tile(&rays[begin], n);
      closest_hits(level_set, tile, primary, {tile_hits.data(), n});
      hit_normals(level_set, tile, {tile_hits.data(), n}, scheme, {normals.data(), n});
      for (std::size_t i = 0; i < n; ++i)
        hits[begin + i] = {bool(tile_hits[i]), tile_hits[i].t, Vec3d(normals[i])};
    });
  };
  // As the renderer does, which draws a buffer for each picture.
  const auto render_with = [&](const std::string& scheme) {
    const Stopwatch watch;
    const MinMaxBuffer buffer(level_set.surface(), grid.transform, view, buffer_cells);
    trace_with(scheme, &buffer);
    return watch.elapsed();
  };
  contestants.push_back({"levelray", [&] { return render_with(setup.normals); }});
  contestants.push_back({"levelray's level set", [&] {
                           const Stopwatch watch;
                           const LevelSet again(grid);
                           const Time time = watch.elapsed();
                           if (again.surface().block_count() != level_set.surface().block_count())
                             throw std::runtime_error("a repeated preparation differs");
                           return time;
                         }});
  contestants.push_back({"OpenVDB LevelSetRayIntersector", [&] {
                           const PeerTime time = peer.trace(rays, peer_hits);
                           return Time{time.wall_ms, time.cpu_ms};
                         }});
  contestants.push_back({"levelray, OpenVDB's normals", [&] { return render_with("analytic"); }});
  contestants.push_back({"levelray, no min/max buffer", [&] { return trace_with(setup.normals, nullptr); }});
#ifdef LEVELRAY_EMBREE
  std::optional<test::EmbreeScene> scene;
  std::vector<test::EmbreeHit> embree_hits(rays.size());
  if (setup.embree) {
    scene.emplace(mesh);
    contestants.push_back({"Embree, single rays", [&] {
                             return by_tiles([&](std::size_t i, std::size_t n) {
                               scene->trace({&rays[i], n}, {&embree_hits[i], n});
                             });
                           }});
    contestants.push_back({"Embree, packets of 16", [&] {
                             return by_tiles([&](std::size_t i, std::size_t n) {
                               scene->trace_packets({&rays[i], n}, {&embree_hits[i], n});
                             });
                           }});
  }
#endif

  std::uint64_t all_steps = 0, all_tests = 0;
  for (const WorldRay& ray : rays) {
    const Hit hit = closest_hit(level_set, ray, setup.intersector);
    all_steps += hit.counts.steps, all_tests += hit.counts.tests;
  }
  const double count = static_cast<double>(rays.size());
  const double steps = static_cast<double>(all_steps) / count, tests = static_cast<double>(all_tests) / count;
  fmt::print("  per ray: {:.2f} steps, {:.2f} tests\n", steps, tests);

  // Everyone's answers before anyone's times.
  for (Contestant& c : contestants) c.run();
  contestants[3].run();
  const double analytic_degrees = agreement(hits, peer_hits, voxel).degrees;
  fmt::print("  analytic normals and OpenVDB's: {:.2g} degrees apart\n", analytic_degrees);
  if (!(analytic_degrees < 0.5)) throw std::runtime_error("analytic normals are not OpenVDB's");
  contestants[0].run();
  const Agreement with_openvdb = agreement(hits, peer_hits, voxel);
  print("OpenVDB", with_openvdb, rays.size());
  nlohmann::json verified{{"openvdb", with_openvdb.json()}};
#ifdef LEVELRAY_EMBREE
  if (scene) {
    const Agreement with_embree = agreement(hits, embree_hits, voxel);
    print("the mesh (Embree)", with_embree, rays.size());
    verified["embree"] = with_embree.json();
  }
#endif
  if (with_openvdb.hits < rays.size() / 100)
    throw std::runtime_error("hardly a ray hits: nothing to measure");
  if (with_openvdb.disagreements() > rays.size() / 1000)
    throw std::runtime_error("levelray and OpenVDB disagree about what is hit");
  if (!(with_openvdb.quantile(0.5) <= 0.01 && with_openvdb.quantile(0.99) <= 0.5))
    throw std::runtime_error("levelray and OpenVDB disagree about where the surface is");

  compete(contestants, setup.repetitions);
  nlohmann::json rows = nlohmann::json::array();
  fmt::print("  {:<32}{:>12}{:>28}{:>20}\n", "", "Mray/s CPU", "CPU ms: median (min-max)", "Mray/s wall");
  for (const Contestant& c : contestants) {
    const Spread p = cpu(c), w = wall(c);
    const bool traces = &c != &contestants[1];
    fmt::print("  {:<32}{:>12}{:>12.1f} ({:.1f}-{:.1f}){:>14}\n", c.name,
               traces ? fmt::format("{:.2f}", count / p.median * 1e-3) : "", p.median, p.min, p.max,
               traces ? fmt::format("{:.2f}", count / w.median * 1e-3) : "");
    rows.push_back(to_json(c));
    if (traces) rows.back()["rays_per_cpu_second"] = count / p.median * 1e3;
    if (traces) rows.back()["rays_per_second"] = count / w.median * 1e3;
  }
  const Contestant &levelray = contestants[0], &prepare = contestants[1], &openvdb = contestants[2];
  const Spread alone = cpu_ratio({&openvdb}, {&levelray}),
               whole = cpu_ratio({&openvdb}, {&levelray, &prepare});
  const Spread alone_wall = wall_ratio({&openvdb}, {&levelray});
  const Spread alike = cpu_ratio({&openvdb}, {&contestants[3]});
  fmt::print(
      "  OpenVDB / levelray, CPU: {:.2f} ({:.2f}-{:.2f}); with the level set's building {:.2f} "
      "({:.2f}-{:.2f}); wall: {:.2f}; with OpenVDB's kind of normals (analytic): {:.2f} ({:.2f}-{:.2f})\n",
      alone.median, alone.min, alone.max, whole.median, whole.min, whole.max, alone_wall.median, alike.median,
      alike.min, alike.max);
  for (std::size_t i = 5; i < contestants.size(); ++i)
    fmt::print("  {} / levelray, CPU: {:.2f}\n", contestants[i].name,
               cpu_ratio({&contestants[i]}, {&levelray}).median);
  fmt::print("\n");
  return {{"resolution", setup.resolution},
          {"image_size", setup.image_size},
          {"intersector", setup.intersector},
          {"normals", setup.normals},
          {"threads", setup.threads},
          {"steps_per_ray", steps},
          {"tests_per_ray", tests},
          {"level_set_bytes", level_set.bytes()},
          {"grid_bytes", grid.bytes()},
          {"verified", verified},
          {"contestants", rows},
          {"cpu_ratio", to_json(alone)},
          {"cpu_ratio_with_level_set", to_json(whole)},
          {"cpu_ratio_with_analytic_normals", to_json(alike)},
          {"wall_ratio", to_json(alone_wall)}};
}

} // namespace levelray::bench
