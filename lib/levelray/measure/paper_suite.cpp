#include "levelray/measure/paper_suite.hpp"

#include "levelray/intersect/intersectors.hpp"
#include "levelray/measure/interleaved_times.hpp"
#include "levelray/measure/printed_tables.hpp"
#include "levelray/measure/ray_sets.hpp"
#include "levelray/measure/study_scene.hpp"
#include "levelray/trace/level_set.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

namespace levelray {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
// The paper's choice for all that does not compare them (section 8).
constexpr std::string_view paper_intersector = "false-position-1",
                           paper_normals = "interpolation-of-differences";

// interleaved_times that says how far it is.
std::vector<TimeSpread> times_of(const std::vector<std::function<void()>>& works, int repetitions,
                                 const PaperProgress& progress) {
  const double all = static_cast<double>(works.size()) * (repetitions + 1);
  double done = 0;
  std::vector<std::function<void()>> reporting;
  for (const auto& work : works)
    reporting.push_back([&] {
      work();
      progress(++done / all);
    });
  return interleaved_times(reporting, repetitions);
}

// A picture as the renderer traces it, tile by tile: hits and normals.
struct Picture {
  const LevelSet& level_set;
  const Camera& camera;
  const std::vector<WorldRay>& rays; // the camera's, in the order of tiled_pixels
  std::vector<std::array<double, 2>> pixels;
  std::vector<Hit> hits;
  std::vector<Vec3f> normals;

  Picture(const LevelSet& of, const Camera& through, const std::vector<WorldRay>& along)
      : level_set(of), camera(through), rays(along), pixels(tiled_pixels(through.settings().width)),
        hits(along.size()), normals(along.size()) {}

  // minmax: the size of the buffers, which are built here; 0: none.
  void trace(std::string_view intersector, std::string_view scheme, Traversal traversal, int minmax) {
    const double size = camera.settings().width;
    std::optional<MinMaxBuffer> buffer;
    if (minmax > 0) {
      PinholeView view{camera.settings().eye, camera.right(), camera.up(), camera.forward()};
      view.half_height = view.half_width = camera.half_height();
      buffer.emplace(level_set.surface(), level_set.grid().transform, view, minmax);
    }
    in_batches(rays.size(), [&](std::size_t begin, std::size_t count) {
      std::array<RayBounds, ray_batch> bounds;
      for (std::size_t i = 0; buffer && i < count; ++i)
        bounds[i] = buffer->at(pixels[begin + i][0] / size, pixels[begin + i][1] / size);
      PrimaryOptions options;
      options.intersector = intersector, options.traversal = traversal;
      if (buffer) options.bounds = {bounds.data(), count};
      const std::span<const WorldRay> some(&rays[begin], count);
      const std::span<Hit> found(&hits[begin], count);
      closest_hits(level_set, some, options, found);
      hit_normals(level_set, some, found, scheme, {&normals[begin], count});
    });
  }
};

// Five lights around the zenith, from the object and from the ground under it, as in the paper's Figure 7. In
// batches of a light's rays from a tile.
std::vector<WorldRay> shadow_rays_of(const Picture& picture, double ground) {
  std::vector<Vec3d> lights;
  for (int i = 0; i < 5; ++i)
    lights.push_back(Vec3d(std::cos(1.2566 * i + 0.5), 1.2, std::sin(1.2566 * i + 0.5)).normalized());
  std::vector<WorldRay> shadows;
  in_batches(picture.rays.size(), [&](std::size_t begin, std::size_t count) {
    for (const Vec3d& light : lights)
      for (std::size_t i = begin; i < begin + count; ++i) {
        const WorldRay& ray = picture.rays[i];
        WorldRay shadow;
        shadow.direction = light;
        if (picture.hits[i]) {
          if (!(Vec3d(picture.normals[i]).dot(light) > 0)) continue;
          shadow.origin = ray.at(picture.hits[i].t_outside);
        } else {
          const double t = (ground - ray.origin.y) / ray.direction.y;
          if (!(t > 0)) continue;
          shadow.origin = ray.at(t);
          if (!(Vec3d(shadow.origin.x, 0, shadow.origin.z).length() < 1.5)) continue;
        }
        shadows.push_back(shadow);
      }
  });
  return shadows;
}

double degrees_between(const Vec3d& a, const Vec3d& b) {
  return std::atan2(a.cross(b).length(), a.dot(b)) * 180 / 3.14159265358979323846;
}

// Of pixels with hits that follow each other in a row of the picture.
std::vector<double> jumps_degrees(const Reference& shape, const Picture& picture,
                                  const std::vector<Hit>& hits) {
  std::vector<double> jumps;
  for (std::size_t i = 1; i < hits.size(); ++i) {
    const auto &a = picture.pixels[i - 1], &b = picture.pixels[i];
    if (!hits[i - 1] || !hits[i] || a[1] != b[1] || a[0] + 1 != b[0]) continue;
    const double ours = degrees_between(Vec3d(picture.normals[i - 1]), Vec3d(picture.normals[i]));
    const double truth = degrees_between(shape.gradient(picture.rays[i - 1].at(hits[i - 1].t)),
                                         shape.gradient(picture.rays[i].at(hits[i].t)));
    jumps.push_back(std::fabs(ours - truth));
  }
  return jumps;
}

bool same(const Hit& a, const Hit& b) {
  return a.status == b.status && a.t == b.t && a.t_outside == b.t_outside && a.cell == b.cell;
}

// Times of ways, `run` of each, unless answers differ.
void time_ways(std::vector<PaperWay>& ways, const std::vector<std::function<void()>>& runs, int repetitions,
               const PaperProgress& progress) {
  const bool right = std::all_of(ways.begin(), ways.end(), [](const PaperWay& w) { return !w.different; });
  const std::vector<TimeSpread> times =
      right && repetitions > 0 ? times_of(runs, repetitions, progress) : std::vector<TimeSpread>();
  for (std::size_t i = 0; i < ways.size(); ++i) {
    ways[i].ms = times.empty() ? nan : times[i].median * 1e-6;
    ways[i].saved = times.empty() ? nan : 1 - median_ratio(times[i], times[ways[i].base]);
  }
}

void measure_primary(PaperScene& scene, Picture& picture, int repetitions, const PaperProgress& progress) {
  for (const bool leaps : {false, true}) {
    const std::size_t base = scene.primary.size();
    const std::string name = leaps ? "leaps" : "plain";
    scene.primary.push_back({name, 0, leaps, base});
    for (const int size : printed_minmax)
      scene.primary.push_back({name + " + min/max " + std::to_string(size), size, leaps, base});
  }
  std::vector<std::function<void()>> runs;
  std::vector<Hit> first;
  std::vector<Vec3f> first_normals;
  for (PaperWay& way : scene.primary) {
    const Traversal traversal = way.leaps ? Traversal::leaps : Traversal::plain;
    runs.push_back([&picture, traversal, minmax = way.size] {
      picture.trace(paper_intersector, paper_normals, traversal, minmax);
    });
    runs.back()();
    if (first.empty()) first = picture.hits, first_normals = picture.normals;
    for (std::size_t i = 0; i < first.size(); ++i) {
      way.different += !same(picture.hits[i], first[i]) || picture.normals[i] != first_normals[i];
      way.counts += picture.hits[i].counts;
    }
  }
  time_ways(scene.primary, runs, repetitions, progress);
}

void measure_shadows(PaperScene& scene, const LevelSet& level_set, const Occluders& occluders,
                     const std::vector<WorldRay>& rays, int repetitions, const PaperProgress& progress) {
  std::vector<ShadowScheme> schemes;
  for (const bool leaps : {false, true}) {
    const std::size_t base = scene.shadow.size();
    const std::string name = leaps ? "leaps" : "plain";
    scene.shadow.push_back({name, 0, leaps, base});
    schemes.push_back(ShadowScheme::plain);
    for (const int n : printed_occluder_steps) {
      scene.shadow.push_back({name + " + occluder n=" + std::to_string(n), n, leaps, base});
      schemes.push_back(ShadowScheme::occluder);
    }
    scene.shadow.push_back({name + " + boxes", 0, leaps, base});
    schemes.push_back(ShadowScheme::boxes);
  }
  std::vector<char> hidden(rays.size()), first;
  std::vector<RayCounts> all_counts(rays.size());
  std::vector<std::function<void()>> runs;
  for (std::size_t w = 0; w < scene.shadow.size(); ++w) {
    PaperWay& way = scene.shadow[w];
    ShadowOptions options;
    options.intersector = paper_intersector;
    options.traversal = way.leaps ? Traversal::leaps : Traversal::plain;
    options.scheme = schemes[w], options.occluder_steps = way.size, options.occluders = &occluders;
    runs.push_back([&, options] {
      in_batches(rays.size(), [&](std::size_t begin, std::size_t count) {
        std::array<bool, ray_batch> found;
        any_hits(level_set, {&rays[begin], count}, options, {found.data(), count},
                 {&all_counts[begin], count});
        std::copy_n(found.begin(), count, hidden.begin() + static_cast<std::ptrdiff_t>(begin));
      });
    });
    runs.back()();
    if (w == 0) first = hidden;
    for (std::size_t i = 0; i < rays.size(); ++i)
      way.different += hidden[i] != first[i], way.counts += all_counts[i];
  }
  time_ways(scene.shadow, runs, repetitions, progress);
}

} // namespace

PaperTorus measure_paper_torus(int resolution, const PaperSettings& settings, const PaperProgress& progress) {
  AnalyticSettings sampling;
  sampling.shapes = {"torus"};
  sampling.half_width_voxels = settings.half_width_voxels;
  sampling.image_size = settings.image_size, sampling.chords = 0;
  const std::vector<Reference> shapes = chosen_references(sampling);
  const SampledShape torus(shapes.front(), resolution, sampling);
  PaperTorus result;
  result.at = torus.at;
  const CameraSettings& view = torus.camera.settings();
  result.voxel_pixels = torus.at.voxel_size * settings.image_size /
                        (2 * torus.camera.half_height() * (view.target - view.eye).length());

  Picture picture(torus.level_set, torus.camera, torus.primary);
  std::vector<std::function<void()>> runs;
  std::vector<std::string> names;
  for (const PrintedMethod& method : printed_table_1) names.emplace_back(method.method);
  names.emplace_back(Exact::name);
  for (const std::string& name : names) {
    runs.push_back([&picture, name] { picture.trace(name, paper_normals, Traversal::plain, 0); });
    runs.back()();
    PaperMethod row;
    row.method = name;
    const Judgement shape = judge_against_shape(torus.reference, torus.rays, torus.truth, picture.hits);
    const Judgement grid = judge_against_grid(torus.at.voxel_size, torus.exact, picture.hits);
    row.shape = shape.confusion, row.grid = grid.confusion;
    row.error = error_statistics(shape.t_errors_voxels);
    row.grid_error = error_statistics(grid.t_errors_voxels);
    // The paper counts the work in one cell: that of rays that looked at the cell of their hit only.
    double rays = 0;
    for (const Hit& hit : picture.hits)
      if (hit && hit.counts.tests == 1)
        ++rays, row.interpolations += hit.counts.interpolations, row.samples += hit.counts.samples;
    row.interpolations /= std::max(rays, 1.0), row.samples /= std::max(rays, 1.0);
    result.intersectors.push_back(row);
  }
  picture.trace(paper_intersector, paper_normals, Traversal::plain, 0);
  const std::vector<Hit> hits = picture.hits;
  for (const PrintedMethod& method : printed_table_2) {
    runs.push_back(
        [&picture, &method] { picture.trace(paper_intersector, method.method, Traversal::plain, 0); });
    PaperMethod row;
    row.method = method.method;
    const RayCounts counts = counts_of_normal(row.method);
    row.samples = counts.samples, row.interpolations = counts.interpolations;
    hit_normals(torus.level_set, torus.rays, hits, row.method, picture.normals);
    row.error = error_statistics(normal_errors_degrees(torus.shape, torus.rays, hits, picture.normals));
    row.jumps = error_statistics(jumps_degrees(torus.shape, picture, hits));
    result.normals.push_back(row);
  }
  const std::vector<TimeSpread> times = settings.repetitions > 0
                                            ? times_of(runs, settings.repetitions, progress)
                                            : std::vector<TimeSpread>(runs.size());
  const auto take = [&](std::vector<PaperMethod>& rows, std::size_t first) {
    for (std::size_t i = 0; i < rows.size(); ++i) {
      rows[i].ms = settings.repetitions > 0 ? times[first + i].median * 1e-6 : nan;
      rows[i].ratio = median_ratio(times[first + i], times[first]);
    }
  };
  take(result.intersectors, 0);
  take(result.normals, result.intersectors.size());
  return result;
}

PaperScene measure_paper_scene(const BlockGrid& grid, double ground, const PaperSettings& settings,
                               const PaperProgress& progress) {
  const LevelSet level_set(grid);
  const Occluders occluders(grid, level_set.surface());
  const Camera camera = study_camera(settings.image_size);
  const std::vector<WorldRay> rays = primary_rays(camera);
  Picture picture(level_set, camera, rays);
  PaperScene scene;
  scene.primary_rays = rays.size();
  measure_primary(scene, picture, settings.repetitions, [&](double done) { progress(0.4 * done); });
  picture.trace(paper_intersector, paper_normals, Traversal::leaps, 0);
  for (const Hit& hit : picture.hits) scene.hits += hit ? 1 : 0;
  const std::vector<WorldRay> shadows = shadow_rays_of(picture, ground);
  scene.shadow_rays = shadows.size();
  measure_shadows(scene, level_set, occluders, shadows, settings.repetitions,
                  [&](double done) { progress(0.4 + 0.6 * done); });
  return scene;
}

} // namespace levelray
