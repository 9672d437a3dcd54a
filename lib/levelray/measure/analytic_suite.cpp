#include "levelray/measure/analytic_suite.hpp"

#include "levelray/core/error.hpp"
#include "levelray/core/nearest_name.hpp"
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

constexpr std::size_t batch = 1024; // as the renderer's tiles
constexpr int minmax_size = 128;

// Calls work(begin, count) for batches of all rays.
template <class Work>
void in_batches(std::size_t count, Work&& work) {
  for (std::size_t begin = 0; begin < count; begin += batch) work(begin, std::min(batch, count - begin));
}

Camera camera_of(const Reference& shape, int size) {
  return Camera(framing_camera(shape.bounds, size, size));
}

// One shape at one resolution.
class Round {
 public:
  Round(const Reference& shape, int resolution, const AnalyticSettings& settings, AnalyticResult& result)
      : shape_(shape), settings_(settings), result_(result), at_{shape.name, resolution, 1.0 / resolution},
        grid_(shape.grid(at_.voxel_size, settings.half_width_voxels)),
        level_set_(grid_), reference_{&shape, at_.voxel_size, static_cast<double>(grid_.background)},
        camera_(camera_of(shape, settings.image_size)), primary_(primary_rays(camera_)),
        chords_(random_chords(shape.bounds, settings.chords, settings.seed)) {
    rays_ = primary_;
    rays_.insert(rays_.end(), chords_.begin(), chords_.end());
    result.samplings.push_back(at_);
    result.primary_rays = primary_.size(), result.chords = chords_.size();
  }

  void run() {
    std::vector<Chord> truth;
    for (const WorldRay& ray : rays_) truth.push_back(shape_.chord(ray));
    exact_.resize(rays_.size());
    closest_hits(level_set_, rays_, Exact::name, exact_);
    solvers(truth);
    normals();
    accelerations();
  }

 private:
  void solvers(const std::vector<Chord>& truth) {
    std::vector<Hit> hits(rays_.size());
    std::vector<std::function<void()>> works;
    const std::size_t first = result_.solvers.size();
    for (const std::string& name : method_names<Intersectors>()) {
      closest_hits(level_set_, rays_, name, hits);
      SolverRow row;
      row.at = at_, row.method = name;
      const Judgement shape = judge_against_shape(reference_, rays_, truth, hits);
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
      row.degrees = error_statistics(normal_errors_degrees(shape_, rays_, exact_, normals));
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
          std::array<bool, batch> found;
          std::array<RayCounts, batch> counts;
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

  const Reference& shape_;
  const AnalyticSettings& settings_;
  AnalyticResult& result_;
  Sampling at_;
  BlockGrid grid_;
  LevelSet level_set_;
  SampledReference reference_;
  Camera camera_;
  std::vector<WorldRay> primary_, chords_, rays_;
  std::vector<Hit> exact_;
};

// Adds a point to the curve of that shape, method and quantity.
void add_point(std::vector<Convergence>& curves, const Reference& shape, const std::string& method,
               const std::string& quantity, double voxel_size, double mean, double median) {
  auto curve = std::find_if(curves.begin(), curves.end(), [&](const Convergence& c) {
    return c.shape == shape.name && c.method == method && c.quantity == quantity;
  });
  if (curve == curves.end()) {
    curves.emplace_back();
    curve = curves.end() - 1;
    curve->shape = shape.name, curve->method = method, curve->quantity = quantity;
    curve->smooth = shape.smooth;
  }
  curve->voxel_sizes.push_back(voxel_size);
  curve->means.push_back(mean);
  curve->medians.push_back(median);
}

} // namespace

AnalyticResult run_analytic_suite(const AnalyticSettings& settings,
                                  const std::function<void(double)>& progress) {
  const std::vector<Reference> all = all_references();
  std::vector<std::string> names;
  for (const Reference& shape : all) names.push_back(shape.name);
  for (const std::string& name : settings.shapes)
    if (std::find(names.begin(), names.end(), name) == names.end()) {
      std::string known;
      for (const std::string& n : names) known += (known.empty() ? "" : ", ") + n;
      throw Error(ErrorKind::usage, "unknown shape '" + printable(name, 80) + "'; there are " + known);
    }

  AnalyticResult result;
  std::vector<const Reference*> chosen;
  for (const Reference& shape : all)
    if (settings.shapes.empty() ||
        std::find(settings.shapes.begin(), settings.shapes.end(), shape.name) != settings.shapes.end())
      chosen.push_back(&shape);
  const double rounds = static_cast<double>(chosen.size() * settings.resolutions.size());
  double done = 0;
  for (const Reference* shape : chosen)
    for (const int resolution : settings.resolutions) {
      check_cancel();
      Round(*shape, resolution, settings, result).run();
      progress(++done / rounds);
    }

  const auto reference = [&](const std::string& name) -> const Reference& {
    return **std::find_if(chosen.begin(), chosen.end(), [&](const Reference* r) { return r->name == name; });
  };
  for (const SolverRow& row : result.solvers) {
    const double h = row.at.voxel_size;
    const Reference& shape = reference(row.at.shape);
    add_point(result.convergence, shape, row.method, "t", h, row.t.mean * h, row.t.p50 * h);
    if (shape.is_distance)
      add_point(result.convergence, shape, row.method, "distance", h, row.distance.mean * h,
                row.distance.p50 * h);
  }
  for (const NormalRow& row : result.normals)
    add_point(result.convergence, reference(row.at.shape), row.method, "normal", row.at.voxel_size,
              row.degrees.mean, row.degrees.p50);
  for (Convergence& curve : result.convergence) {
    curve.mean_slope = log_log_slope(curve.voxel_sizes, curve.means);
    curve.median_slope = log_log_slope(curve.voxel_sizes, curve.medians);
  }
  return result;
}

} // namespace levelray
