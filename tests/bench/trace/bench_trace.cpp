// Rays per second of the tracer alone, on one thread: for work on the tracer, not for the record.
//
//   bench_trace FILE.vdb [SIZE [REPEATS]]
//
// SIZE^2 primary rays, 45 degrees, from direction (0.35, 0.30, 1), the object filling the frame; then the
// same with normals, a shadow ray per hit towards one light, and OpenVDB's LevelSetRayIntersector on the same
// grid. The things compared take turns, and the median is printed. Before any timing the hits are verified:
// any_hit agrees, and the interpolated value at every hit is 0 within what the place along the ray is worth.
#include "levelray/core/parallel.hpp"
#include "levelray/grid/cell_segment.hpp"
#include "levelray/render/camera.hpp"
#include "levelray/trace/level_set.hpp"
#include "levelray/vdb/to_openvdb.hpp"
#include "levelray/vdb/vdb_file.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <openvdb/tools/RayIntersector.h>
#include <string>
#include <vector>

using namespace levelray;

namespace {

constexpr int tile = 32;

// The rays of an image in the order of its 32x32 tiles.
std::vector<WorldRay> primary_rays(const BlockGrid& grid, int size) {
  const Box3i samples = grid.active_bounds();
  const Vec3d low = grid.transform.to_world(Vec3d(samples.min)),
              high = grid.transform.to_world(Vec3d(samples.max));
  CameraSettings settings;
  settings.width = settings.height = size;
  settings.target = (low + high) * 0.5;
  // The longest side of the object (the box without the band) fills the view as in the study: 41-43 % hit.
  double side = 0;
  for (int a = 0; a < 3; ++a) side = std::max(side, high[a] - low[a] - 2 * double(grid.background));
  settings.eye = settings.target + Vec3d(0.35, 0.30, 1).normalized() * (1.58 * side);
  const Camera camera(settings);
  std::vector<WorldRay> rays;
  for (int ty = 0; ty < size; ty += tile)
    for (int tx = 0; tx < size; tx += tile)
      for (int y = ty; y < std::min(ty + tile, size); ++y)
        for (int x = tx; x < std::min(tx + tile, size); ++x) rays.push_back(camera.ray(x + 0.5, y + 0.5));
  return rays;
}

std::vector<WorldRay> shadow_rays(const std::vector<WorldRay>& rays, const std::vector<Hit>& hits,
                                  const std::vector<Vec3f>& normals) {
  const Vec3d to_light = Vec3d(0.4, 0.8, 0.45).normalized();
  std::vector<WorldRay> shadows;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (!hits[i] || Vec3d(normals[i]).dot(to_light) <= 0) continue;
    WorldRay ray;
    ray.origin = rays[i].at(hits[i].t_outside);
    ray.direction = to_light;
    shadows.push_back(ray);
  }
  return shadows;
}

// The interpolated value at a hit, which must be 0 but for the rounding of t: 2^-50 of the way times a slope
// of 2.
std::size_t wrong_hits(const LevelSet& level_set, const std::vector<WorldRay>& rays,
                       const std::vector<Hit>& hits) {
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    wrong += bool(hits[i]) != any_hit(level_set, rays[i]);
    if (!hits[i]) continue;
    CellSegment cell;
    const Vec3d p = level_set.grid().transform.to_voxel(rays[i].at(hits[i].t));
    for (int a = 0; a < 3; ++a) {
      cell.in.x[a] = p[a] - hits[i].cell[a];
      cell.in.rest[a] = 1 - cell.in.x[a];
    }
    for (int c = 0; c < 8; ++c)
      cell.corner[c] = level_set.grid().value(hits[i].cell.x + (c & 1), hits[i].cell.y + (c >> 1 & 1),
                                              hits[i].cell.z + (c >> 2));
    const double far = rays[i].origin.length() + std::fabs(hits[i].t);
    wrong += !(std::fabs(interpolate(cell.corner, cell.in)) <=
               0x1p-38 * level_set.grid().background + 0x1p-49 * far);
  }
  return wrong;
}

// Processor time: other work on the machine disturbs it least, and everything here runs on one thread.
double seconds(const std::function<void()>& work) {
  const std::clock_t start = std::clock();
  work();
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

} // namespace

int main(int argc, char** argv) {
  if (argc < 2) return std::fprintf(stderr, "bench_trace FILE.vdb [SIZE [REPEATS]]\n"), 2;
  const int size = argc > 2 ? std::atoi(argv[2]) : 512, repeats = argc > 3 ? std::atoi(argv[3]) : 7;
  VdbReadOptions options;
  options.trust_input = true;
  const VdbFile file = read_vdb(argv[1], options);
  const ThreadLimit one_thread(1);
  const double build = seconds([&] { LevelSet(file.grid); });
  const LevelSet level_set(file.grid);

  const std::vector<WorldRay> rays = primary_rays(file.grid, size);
  std::vector<Hit> hits(rays.size());
  std::vector<Vec3f> normals(rays.size());
  closest_hits(level_set, rays, "exact", hits);
  hit_normals(level_set, rays, hits, "interpolation-of-differences", normals);
  const std::vector<WorldRay> shadows = shadow_rays(rays, hits, normals);
  if (const std::size_t wrong = wrong_hits(level_set, rays, hits))
    return std::fprintf(stderr, "%zu hits are wrong\n", wrong), 1;
  std::size_t hit = 0;
  std::uint64_t steps = 0, tests = 0;
  for (const Hit& h : hits) hit += bool(h), steps += h.counts.steps, tests += h.counts.tests;
  std::printf(
      "%zu rays, %.1f %% hit, %.1f steps and %.2f tests per ray; level set built in %.1f ms, %.1f MB\n",
      rays.size(), 100. * double(hit) / double(rays.size()), double(steps) / double(rays.size()),
      double(tests) / double(rays.size()), build * 1e3, double(level_set.bytes()) / 1e6);

  initialize_openvdb();
  const auto vdb = to_openvdb(file.grid);
  openvdb::tools::LevelSetRayIntersector<openvdb::FloatGrid> intersector(*vdb);
  const std::size_t tile_rays = tile * tile;
  const auto by_tile = [&](const auto& work) {
    for (std::size_t i = 0; i < rays.size(); i += tile_rays) work(i, std::min(tile_rays, rays.size() - i));
  };
  struct Row {
    const char* name;
    std::size_t rays;
    std::function<void()> work;
    std::vector<double> times = {};
  };
  const auto primary = [&](std::string_view intersector_name, std::string_view scheme) {
    by_tile([&, intersector_name, scheme](std::size_t i, std::size_t n) {
      const std::span ray_tile(&rays[i], n);
      const std::span hit_tile(&hits[i], n);
      closest_hits(level_set, ray_tile, intersector_name, hit_tile);
      if (!scheme.empty()) hit_normals(level_set, ray_tile, hit_tile, scheme, {&normals[i], n});
    });
  };
  std::vector<char> vdb_hits(rays.size());
  Row rows[] = {
      {"depth, midpoint", rays.size(), [&] { primary("midpoint", ""); }},
      {"depth, false-position-1", rays.size(), [&] { primary("false-position-1", ""); }},
      {"depth, exact", rays.size(), [&] { primary("exact", ""); }},
      {"primary, exact, analytic", rays.size(), [&] { primary("exact", "analytic"); }},
      {"primary, exact, interpolation-of-differences", rays.size(),
       [&] { primary("exact", "interpolation-of-differences"); }},
      {"shadow, exact", shadows.size(),
       [&] {
         std::vector<char> occluded(shadows.size());
         any_hits(level_set, shadows, "exact", {reinterpret_cast<bool*>(occluded.data()), occluded.size()});
       }},
      {"OpenVDB primary", rays.size(),
       [&] {
         openvdb::Vec3d xyz(0), normal(0);
         double t = 0;
         for (std::size_t i = 0; i < rays.size(); ++i) {
           const WorldRay& r = rays[i];
           const openvdb::math::Ray<double> ray({r.origin.x, r.origin.y, r.origin.z},
                                                {r.direction.x, r.direction.y, r.direction.z});
           vdb_hits[i] = intersector.intersectsWS(ray, xyz, normal, t);
           if (vdb_hits[i]) normals[i] = Vec3f(float(normal[0]), float(normal[1]), float(normal[2]));
         }
       }},
  };
  for (int r = 0; r < repeats; ++r)
    for (Row& row : rows) row.times.push_back(seconds(row.work));
  double peer = 0;
  for (Row& row : rows) {
    std::sort(row.times.begin(), row.times.end());
    peer = row.times[row.times.size() / 2];
  }
  for (const Row& row : rows) {
    const double median = row.times[row.times.size() / 2];
    std::printf("%-46s %7.2f Mray/s (best %6.2f)  %5.2f x OpenVDB primary\n", row.name,
                double(row.rays) / median * 1e-6, double(row.rays) / row.times[0] * 1e-6,
                peer / double(rays.size()) / (median / double(row.rays)));
  }
  return 0;
}
