#include "levelray/measure/grid_suite.hpp"

#include "levelray/core/parallel.hpp"
#include "levelray/intersect/intersectors.hpp"
#include "levelray/measure/hit_judgement.hpp"
#include "levelray/measure/interleaved_times.hpp"
#include "levelray/measure/ray_sets.hpp"
#include "levelray/measure/sampled_shape.hpp"
#include "levelray/normal/normals.hpp"
#include "levelray/trace/all_hits.hpp"
#include "levelray/trace/certified_hit.hpp"
#include "levelray/trace/level_set.hpp"
#include "levelray/trace/ray_values.hpp"

#include <algorithm>
#include <cmath>

namespace levelray {

namespace {

Box3d active_box(const BlockGrid& grid) {
  const Box3i samples = grid.active_bounds();
  return samples.isEmpty() ? Box3d(Vec3d(0, 0, 0), Vec3d(0, 0, 0))
                           : Box3d(grid.transform.to_world(Vec3d(samples.min)),
                                   grid.transform.to_world(Vec3d(samples.max)));
}

// From a place of the surface along a unit direction to the next one: how thick the solid is there against
// the normal, or how wide the gap along it. The ray begins half a voxel before the place and looks for the
// crossing of that kind that is nearest to it, so it needs no epsilon. 0 where nothing comes behind.
double next_crossing(const LevelSet& level_set, const Vec3d& place, const Vec3d& direction, PlaceKind kind,
                     std::vector<SurfacePlace>& places) {
  const double half = 0.5 * level_set.grid().transform.voxel_size;
  WorldRay ray;
  ray.origin = place - direction * half;
  ray.direction = direction;
  all_hits(level_set, ray, places);
  std::size_t nearest = places.size();
  for (std::size_t i = 0; i < places.size(); ++i)
    if (places[i].kind == kind &&
        (nearest == places.size() || std::fabs(places[i].t - half) < std::fabs(places[nearest].t - half)))
      nearest = i;
  for (std::size_t i = nearest + 1; i < places.size(); ++i)
    if (places[i].kind != PlaceKind::touch) return places[i].t - places[nearest].t;
  return 0;
}

class Run {
 public:
  Run(const BlockGrid& grid, const GridSuiteSettings& settings)
      : grid_(grid), settings_(settings), level_set_(grid),
        rays_(random_chords(active_box(grid), settings.rays, settings.seed)), exact_(rays_.size()) {
    result_.megabytes = static_cast<double>(grid.bytes() + level_set_.bytes()) * 1e-6;
    result_.rays = rays_.size();
    closest_hits(level_set_, rays_, Exact::name, exact_);
    for (const Hit& hit : exact_) result_.hits += bool(hit);
  }

  void proofs() {
    struct Seen {
      Proof proof = Proof::miss;
      double bound = 0;
      bool odd = false;
    };
    std::vector<Seen> seen(rays_.size());
    parallel_for(rays_.size(), 64, [&](std::size_t begin, std::size_t end) {
      std::vector<SurfacePlace> places;
      for (std::size_t i = begin; i < end; ++i) {
        const CertifiedHit certified = certify(level_set_, rays_[i], exact_[i]);
        const EndSides sides = all_hits(level_set_, rays_[i], places);
        int crossings = 0;
        for (const SurfacePlace& place : places) crossings += place.kind != PlaceKind::touch;
        seen[i] = {certified.proof, certified.error,
                   sides.first * sides.last != 0 && (crossings % 2 != 0) != (sides.first != sides.last)};
      }
    });
    std::vector<double> bounds;
    for (std::size_t i = 0; i < seen.size(); ++i) {
      result_.odd += seen[i].odd;
      if (!exact_[i]) continue;
      result_.crossings += seen[i].proof == Proof::crossing;
      result_.grazes += seen[i].proof == Proof::graze;
      result_.refuted += seen[i].proof == Proof::refuted;
      if (seen[i].proof == Proof::crossing) bounds.push_back(seen[i].bound / grid_.transform.voxel_size);
    }
    result_.bounds_voxels = error_statistics(std::move(bounds));
  }

  void thickness() {
    std::vector<double> inward(rays_.size()), outward(rays_.size());
    parallel_for(rays_.size(), 64, [&](std::size_t begin, std::size_t end) {
      std::vector<SurfacePlace> places;
      for (std::size_t i = begin; i < end; ++i) {
        if (!exact_[i] || exact_[i].from_inside) continue;
        const Vec3d normal(hit_normal(level_set_, rays_[i], exact_[i]));
        const Vec3d place = rays_[i].at(exact_[i].t);
        inward[i] = next_crossing(level_set_, place, -normal, PlaceKind::enters, places);
        outward[i] = next_crossing(level_set_, place, normal, PlaceKind::leaves, places);
      }
    });
    result_.thickness =
        thickness_statistics(std::move(inward), std::move(outward), {grid_.transform.voxel_size});
  }

  void intersectors() {
    std::vector<Hit> hits(rays_.size());
    std::vector<std::function<void()>> works;
    const std::size_t first = result_.trade.size();
    for (const std::string& name : method_names<Intersectors>()) {
      closest_hits(level_set_, rays_, name, hits);
      TradeRow row = trade_row(name, false);
      row.lost = judge_against_grid(grid_.transform.voxel_size, exact_, hits).confusion.lost();
      std::vector<double> errors;
      for (std::size_t i = 0; i < hits.size(); ++i)
        if (hits[i]) errors.push_back(std::fabs(RayValues(grid_, rays_[i]).at(hits[i].t).value));
      row.error = error_statistics(std::move(errors));
      result_.trade.push_back(row);
      works.push_back([this, &hits, name] {
        in_batches(rays_.size(), [&](std::size_t begin, std::size_t count) {
          closest_hits(level_set_, {&rays_[begin], count}, name, {&hits[begin], count});
        });
      });
    }
    time(works, first, result_.rays);
  }

  void normals() {
    std::vector<Vec3f> truth(rays_.size()), normals(rays_.size());
    hit_normals(level_set_, rays_, exact_, AnalyticNormal::name, truth);
    std::vector<std::function<void()>> works;
    const std::size_t first = result_.trade.size();
    for (const std::string& name : method_names<NormalSchemes>()) {
      hit_normals(level_set_, rays_, exact_, name, normals);
      std::vector<double> angles;
      for (std::size_t i = 0; i < exact_.size(); ++i)
        if (exact_[i]) {
          const Vec3d a(truth[i]), b(normals[i]);
          angles.push_back(std::atan2(a.cross(b).length(), a.dot(b)) * 180 / 3.14159265358979323846);
        }
      TradeRow row = trade_row(name, true);
      row.error = error_statistics(std::move(angles));
      result_.trade.push_back(row);
      works.push_back([this, &normals, name] {
        in_batches(rays_.size(), [&](std::size_t begin, std::size_t count) {
          hit_normals(level_set_, {&rays_[begin], count}, {&exact_[begin], count}, name,
                      {&normals[begin], count});
        });
      });
    }
    time(works, first, result_.hits);
  }

  GridSuiteResult take() {
    mark_front(result_.trade);
    return std::move(result_);
  }

 private:
  TradeRow trade_row(const std::string& method, bool is_normals) const {
    TradeRow row;
    row.method = method, row.is_normals = is_normals, row.megabytes = result_.megabytes;
    return row;
  }
  void time(const std::vector<std::function<void()>>& works, std::size_t first, std::uint64_t per) {
    const std::vector<TimeSpread> times = interleaved_times(works, settings_.repetitions);
    for (std::size_t i = 0; i < times.size(); ++i)
      result_.trade[first + i].ns = times[i].median / static_cast<double>(std::max<std::uint64_t>(per, 1));
  }

  const BlockGrid& grid_;
  const GridSuiteSettings& settings_;
  const LevelSet level_set_;
  const std::vector<WorldRay> rays_;
  std::vector<Hit> exact_;
  GridSuiteResult result_;
};

} // namespace

GridSuiteResult run_grid_suite(const BlockGrid& grid, const GridSuiteSettings& settings,
                               const std::function<void(double)>& progress) {
  Run run(grid, settings);
  run.proofs();
  run.thickness();
  progress(0.3);
  const ThreadLimit one_thread(1);
  run.intersectors();
  progress(0.7);
  run.normals();
  progress(1);
  return run.take();
}

} // namespace levelray
