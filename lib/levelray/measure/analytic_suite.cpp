#include "levelray/measure/analytic_suite.hpp"

#include "levelray/core/parallel.hpp"
#include "levelray/intersect/intersectors.hpp"
#include "levelray/measure/interleaved_times.hpp"
#include "levelray/measure/ray_sets.hpp"
#include "levelray/normal/normals.hpp"
#include "levelray/trace/level_set.hpp"

#include <algorithm>
#include <array>
#include <map>

namespace levelray {

namespace {

constexpr int minmax_size = 128;

// One shape at one resolution.
class Round {
 public:
  Round(const SampledShape& sampled, const AnalyticSettings& settings, AnalyticResult& result)
      : sampled_(sampled), settings_(settings), result_(result), at_(sampled.at), grid_(sampled.grid),
        level_set_(sampled.level_set), camera_(sampled.camera), primary_(sampled.primary),
        chords_(sampled.chords), rays_(sampled.rays), exact_(sampled.exact) {
    result.samplings.push_back(at_);
    result.primary_rays = primary_.size(), result.chords = chords_.size();
  }

  void run() {
    solvers();
    normals();
    accelerations();
  }

 private:
  void solvers() {
    std::vector<Hit> hits(rays_.size());
    std::vector<std::function<void()>> works;
    const std::size_t first = result_.solvers.size();
    for (const std::string& name : method_names<Intersectors>()) {
      closest_hits(level_set_, rays_, name, hits);
      SolverRow row;
      row.at = at_, row.method = name;
      const Judgement shape = judge_against_shape(sampled_.reference, rays_, sampled_.truth, hits);
      const Judgement grid = judge_against_grid(at_.voxel_size, exact_, hits);
      row.shape = shape.confusion, row.grid = grid.confusion;
      row.t = error_statistics(shape.t_errors_voxels);
      row.distance = error_statistics(shape.distance_errors_voxels);
      row.grid_t = error_statistics(grid.t_errors_voxels);
      CountSums sums;
      double found = 0;
      for (const Hit& hit : hits) sums += hit.counts, found += hit ? 1 : 0;
      found = std::max(found, 1.0);
      row.steps = static_cast<double>(sums.steps) / found;
      row.samples = static_cast<double>(sums.samples) / found;
      row.interpolations = static_cast<double>(sums.interpolations) / found;
      result_.solvers.push_back(row);
      for (const std::vector<WorldRay>* rays : {&primary_, &chords_})
        works.push_back([this, &hits, rays, name] {
          in_batches(rays->size(), [&](std::size_t begin, std::size_t count) {
            closest_hits(level_set_, {&(*rays)[begin], count}, name, {&hits[begin], count});
          });
        });
    }
    const std::vector<TimeSpread> times = interleaved_times(works, settings_.repetitions);
    for (std::size_t i = 0; i < times.size(); i += 2) {
      SolverRow& row = result_.solvers[first + i / 2];
      row.primary_ns = times[i].median / static_cast<double>(primary_.size());
      row.chord_ns = times[i + 1].median / static_cast<double>(chords_.size());
    }
  }

  void normals() {
    std::vector<Vec3f> normals(rays_.size());
    std::vector<std::function<void()>> works;
    const std::size_t first = result_.normals.size();
    double found = 0;
    for (const Hit& hit : exact_) found += hit ? 1 : 0;
    for (const std::string& name : method_names<NormalSchemes>()) {
      NormalRow row;
      row.at = at_, row.method = name;
      hit_normals(level_set_, rays_, exact_, name, normals);
      row.degrees = error_statistics(normal_errors_degrees(sampled_.shape, rays_, exact_, normals));
      const RayCounts counts = counts_of_normal(name);
      row.samples = counts.samples, row.interpolations = counts.interpolations;
      result_.normals.push_back(row);
      works.push_back([this, &normals, name] {
        in_batches(rays_.size(), [&](std::size_t begin, std::size_t count) {
          hit_normals(level_set_, {&rays_[begin], count}, {&exact_[begin], count}, name,
                      {&normals[begin], count});
        });
      });
    }
    const std::vector<TimeSpread> times = interleaved_times(works, settings_.repetitions);
    for (std::size_t i = 0; i < times.size(); ++i)
      result_.normals[first + i].ns = times[i].median / std::max(found, 1.0);
  }

  // The ways to trace primary rays and chords, and any hit along chords, compared bit for bit.
  void accelerations() {
    const SurfaceBlocks& surface = level_set_.surface();
    const Camera& camera = camera_;
    PinholeView view{camera.settings().eye, camera.right(), camera.up(), camera.forward()};
    view.half_width = view.half_height = camera.half_height();
    const MinMaxBuffer buffer(surface, grid_.transform, view, minmax_size);
    std::vector<RayBounds> bounds;
    for (const auto& [x, y] : tiled_pixels(settings_.image_size))
      bounds.push_back(buffer.at(x / settings_.image_size, y / settings_.image_size));
    const Occluders occluders(grid_, surface);

    struct Way {
      std::string name, rays;
      std::function<void(std::string_view intersector)> run;
    };
    std::vector<Hit> hits(rays_.size());
    const auto closest = [&](const std::vector<WorldRay>& rays, Traversal traversal, bool minmax) {
      return [&, traversal, minmax](std::string_view intersector) {
        in_batches(rays.size(), [&](std::size_t begin, std::size_t count) {
          PrimaryOptions options;
          options.intersector = intersector, options.traversal = traversal;
          if (minmax) options.bounds = {&bounds[begin], count};
          closest_hits(level_set_, {&rays[begin], count}, options, {&hits[begin], count});
        });
      };
    };
    const auto any = [&](Traversal traversal, ShadowScheme scheme) {
      return [&, traversal, scheme](std::string_view intersector) {
        ShadowOptions options;
        options.intersector = intersector, options.traversal = traversal;
        options.scheme = scheme, options.occluders = &occluders;
        in_batches(chords_.size(), [&](std::size_t begin, std::size_t count) {
          std::array<bool, ray_batch> found;
          std::array<RayCounts, ray_batch> counts;
          any_hits(level_set_, {&chords_[begin], count}, options, {found.data(), count},
                   {counts.data(), count});
          for (std::size_t i = 0; i < count; ++i) {
            Hit& hit = hits[begin + i] = Hit();
            hit.status = found[i] ? HitStatus::hit : HitStatus::miss;
            hit.counts = counts[i];
          }
        });
      };
    };
    const std::vector<std::string>& traversals = traversal_names();
    std::vector<Way> ways;
    for (std::size_t i = 0; i < traversals.size(); ++i)
      ways.push_back({traversals[i], "primary", closest(primary_, static_cast<Traversal>(i), false)});
    for (std::size_t i = 0; i < traversals.size(); ++i)
      ways.push_back(
          {traversals[i] + " + min/max", "primary", closest(primary_, static_cast<Traversal>(i), true)});
    for (std::size_t i = 0; i < traversals.size(); ++i)
      ways.push_back({traversals[i], "chords", closest(chords_, static_cast<Traversal>(i), false)});
    for (std::size_t s = 0; s < shadow_scheme_names().size(); ++s)
      for (std::size_t i = 0; i < traversals.size(); ++i)
        ways.push_back({traversals[i] + " + " + shadow_scheme_names()[s], "shadow",
                        any(static_cast<Traversal>(i), static_cast<ShadowScheme>(s))});

    const auto same = [](const Hit& a, const Hit& b) {
      return a.status == b.status && a.t == b.t && a.t_outside == b.t_outside && a.cell == b.cell;
    };
    const std::size_t first = result_.accelerations.size();
    std::vector<std::function<void()>> works;
    std::map<std::string, std::map<std::string, std::vector<Hit>>> firsts; // by rays and intersector
    for (const Way& way : ways) {
      AccelerationRow row;
      row.at = at_, row.method = way.name, row.rays = way.rays;
      const std::size_t count = way.rays == "primary" ? primary_.size() : chords_.size();
      for (const std::string& intersector : method_names<Intersectors>()) {
        way.run(intersector);
        const auto [known, is_first] = firsts[way.rays].try_emplace(
            intersector, hits.begin(), hits.begin() + static_cast<std::ptrdiff_t>(count));
        for (std::size_t i = 0; i < count && !is_first; ++i)
          row.different += !same(hits[i], known->second[i]);
        if (intersector != Exact::name) continue;
        CountSums sums;
        for (std::size_t i = 0; i < count; ++i) sums += hits[i].counts;
        row.steps = static_cast<double>(sums.steps) / static_cast<double>(count);
        row.tests = static_cast<double>(sums.tests) / static_cast<double>(count);
      }
      result_.accelerations.push_back(row);
      works.push_back([&way] { way.run(Exact::name); });
    }
    const std::vector<TimeSpread> times = interleaved_times(works, settings_.repetitions);
    for (std::size_t i = 0; i < times.size(); ++i) {
      AccelerationRow& row = result_.accelerations[first + i];
      row.ns =
          times[i].median / static_cast<double>(row.rays == "primary" ? primary_.size() : chords_.size());
    }
  }

  const SampledShape& sampled_;
  const AnalyticSettings& settings_;
  AnalyticResult& result_;
  const Sampling& at_;
  const BlockGrid& grid_;
  const LevelSet& level_set_;
  const Camera& camera_;
  const std::vector<WorldRay>&primary_, &chords_, &rays_;
  const std::vector<Hit>& exact_;
};

} // namespace

AnalyticResult run_analytic_suite(const AnalyticSettings& settings,
                                  const std::function<void(double)>& progress) {
  const std::vector<Reference> shapes = chosen_references(settings);
  AnalyticResult result;
  ConvergenceCurves curves;
  const double rounds = static_cast<double>(shapes.size() * settings.resolutions.size());
  double done = 0;
  for (const Reference& shape : shapes)
    for (const int resolution : settings.resolutions) {
      check_cancel();
      const std::size_t solver = result.solvers.size(), normal = result.normals.size();
      const SampledShape sampled(shape, resolution, settings);
      Round(sampled, settings, result).run();
      const double h = sampled.at.voxel_size;
      for (std::size_t i = solver; i < result.solvers.size(); ++i) {
        const SolverRow& row = result.solvers[i];
        curves.add(shape, row.method, "t", h, row.t.mean * h, row.t.p50 * h);
        if (shape.is_distance)
          curves.add(shape, row.method, "distance", h, row.distance.mean * h, row.distance.p50 * h);
      }
      for (std::size_t i = normal; i < result.normals.size(); ++i) {
        const NormalRow& row = result.normals[i];
        curves.add(shape, row.method, "normal", h, row.degrees.mean, row.degrees.p50);
      }
      progress(++done / rounds);
    }
  result.convergence = curves.finish();
  return result;
}

} // namespace levelray
