#include "levelray/measure/surface_judge.hpp"

#include "levelray/core/parallel.hpp"
#include "levelray/measure/error_statistics.hpp"
#include "levelray/trace/field_probe.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace levelray {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

} // namespace

std::int64_t allowed_exceedances(std::size_t count) {
  const double mean = static_cast<double>(count) * tolerated_share;
  // P(X = k) by its logarithm, so that large means do not underflow: e^-mean is 0 beyond 745.
  double sum = 0;
  for (std::int64_t k = 0;; ++k) {
    const auto n = static_cast<double>(k);
    sum += std::exp(n * std::log(mean) - mean - std::lgamma(n + 1));
    if (!(sum <= 1.0 / 40)) return k - 1;
  }
}

double SurfaceErrors::quantile() const {
  return errors.empty() ? 0 : error_quantile(errors, 1 - tolerated_share);
}

double SurfaceErrors::largest() const {
  return errors.size() > lost ? errors[errors.size() - lost - 1] : 0;
}

double SurfaceErrors::demonstrated() const {
  if (errors.empty()) return 0;
  const auto above = static_cast<std::size_t>(std::max<std::int64_t>(0, allowed_exceedances(errors.size())));
  return errors[errors.size() - 1 - above];
}

SurfaceJudge::SurfaceJudge(const SurfaceTruth& truth, const LevelSet& level_set,
                           std::span<const WorldRay> rays, std::span<const std::optional<TruePlace>> places)
    : truth_(truth), level_set_(level_set), rays_(rays), places_(places), exact_(rays.size()),
      from_truth_(rays.size(), 0) {
  const double across = truth.bounds().isEmpty() ? 0 : truth.bounds().size().length();
  parallel_for(rays.size(), 256, [&](std::size_t begin, std::size_t end) {
    closest_hits(level_set, rays.subspan(begin, end - begin), PrimaryOptions(),
                 std::span(exact_).subspan(begin, end - begin));
    for (std::size_t i = begin; i < end; ++i)
      if (places[i]) {
        const double bound = exact_[i] ? std::fabs(exact_[i].t - places[i]->t) : across;
        from_truth_[i] = distance_to_zero_set(level_set, places[i]->position, places[i]->normal, bound);
      }
  });
}

SurfaceErrors SurfaceJudge::errors(std::string_view intersector, double tolerance) const {
  const double cell = std::sqrt(3.0) * level_set_.grid().transform.voxel_size;
  std::vector<double> errors(rays_.size(), 0);
  std::vector<Hit> hits(rays_.size());
  PrimaryOptions options;
  options.intersector = intersector;
  parallel_for(rays_.size(), 256, [&](std::size_t begin, std::size_t end) {
    closest_hits(level_set_, rays_.subspan(begin, end - begin), options,
                 std::span(hits).subspan(begin, end - begin));
    for (std::size_t i = begin; i < end; ++i) {
      const Hit &hit = hits[i], &exact = exact_[i];
      if (exact && !hit) {
        errors[i] = infinity;
        continue;
      }
      if (!hit) {
        errors[i] = places_[i] ? from_truth_[i] : -1; // -1: nothing to judge
        continue;
      }
      const Vec3d p = rays_[i].at(hit.t);
      const double behind = exact ? hit.t - exact.t : 0;
      // The same surface? Behind a thin sheet's front lies its back, where the ray goes towards larger
      // values.
      const auto on_back = [&] {
        const double along = probe_field(level_set_.grid(), p).gradient.dot(rays_[i].direction);
        return !hit.from_inside && along > 0;
      };
      if ((behind > cell && hit.cell != exact.cell) || (behind > tolerance && on_back())) {
        errors[i] = infinity;
        continue;
      }
      const double from_hit = truth_.distance(p, places_[i] ? std::fabs(hit.t - places_[i]->t) : infinity);
      errors[i] = std::isnan(from_hit) ? -2 : std::max(from_hit, from_truth_[i]); // -2: closes a hole
    }
  });
  SurfaceErrors result;
  for (const double e : errors) {
    if (e >= 0) result.errors.push_back(e);
    result.lost += e == infinity;
    result.not_judged += e == -2;
  }
  std::sort(result.errors.begin(), result.errors.end());
  return result;
}

CountSums SurfaceJudge::counts() const {
  CountSums sums;
  for (const Hit& hit : exact_) sums += hit.counts;
  return sums;
}

double SurfaceJudge::normals_median_degrees(std::string_view scheme) const {
  std::vector<std::size_t> some;
  for (std::size_t i = 0; i < exact_.size() && some.size() < 4096; ++i)
    if (exact_[i]) some.push_back(i);
  std::vector<double> angles(some.size());
  parallel_for(some.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const std::size_t i = some[k];
      const Vec3d n(hit_normal(level_set_, rays_[i], exact_[i], scheme));
      const Vec3d truth = truth_.normal(rays_[i].at(exact_[i].t));
      angles[k] = std::atan2(truth.cross(n).length(), truth.dot(n)) * 180 / 3.14159265358979323846;
    }
  });
  return error_statistics(std::move(angles)).p50;
}

std::vector<std::optional<TruePlace>> first_places(const SurfaceTruth& truth,
                                                   std::span<const WorldRay> rays) {
  std::vector<std::optional<TruePlace>> places(rays.size());
  parallel_for(rays.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) places[i] = truth.first_place(rays[i]);
  });
  return places;
}

} // namespace levelray
