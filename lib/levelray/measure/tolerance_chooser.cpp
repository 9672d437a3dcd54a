#include "levelray/measure/tolerance_chooser.hpp"

#include "levelray/core/error.hpp"
#include "levelray/core/parallel.hpp"
#include "levelray/intersect/intersectors.hpp"
#include "levelray/measure/half_storage.hpp"
#include "levelray/measure/method_costs.hpp"
#include "levelray/measure/ray_sets.hpp"
#include "levelray/normal/normals.hpp"

#include <algorithm>
#include <cmath>

namespace levelray {

namespace {

constexpr std::size_t wanted_places = 20000;
constexpr std::uint64_t choosing_seed = 1, verifying_seed = 2;

// So many rays that the wanted number of them meets the truth, 2^20 at most. A shape that fills a 50th of
// its box's sphere is met often enough.
RaySet draw_rays(const SurfaceTruth& truth, const ToleranceRequest& request, const LevelSet& level_set,
                 std::uint64_t seed) {
  RaySet set;
  std::size_t met = 0;
  for (std::size_t count = 1 << 15;; count *= 2) {
    check_cancel();
    set.rays =
        request.rays ? request.rays(level_set, seed, count) : random_chords(truth.bounds(), count, seed);
    const std::size_t known = set.places.size();
    const auto more = first_places(truth, std::span<const WorldRay>(set.rays).subspan(known));
    for (const auto& place : more) {
      set.places.push_back(place);
      if (place && ++met == wanted_places) {
        set.rays.resize(set.places.size());
        return set;
      }
    }
    if (count >= 1 << 20 || set.rays.size() < count) return set;
  }
}

std::vector<std::string> smooth_normals_by_cost() {
  std::vector<std::string> names = normals_by_cost();
  std::erase_if(names, [](const std::string& name) {
    bool smooth = false;
    visit_method<NormalSchemes>(name, [&]<class Scheme>(Scheme) { smooth = Scheme::smooth; });
    return !smooth;
  });
  return names;
}

AchievedError achieved_by(const SurfaceErrors& errors) {
  AchievedError achieved;
  achieved.p999 = errors.quantile(), achieved.largest = errors.largest();
  achieved.demonstrated = errors.demonstrated();
  achieved.rays = errors.rays(), achieved.lost = errors.lost, achieved.not_judged = errors.not_judged;
  return achieved;
}

} // namespace

std::vector<std::string> intersectors_for(const ToleranceRequest& request) {
  if (request.intersector.empty()) return intersectors_by_cost();
  intersector_cost(request.intersector); // throws
  return {request.intersector};
}

std::string best_intersector(const ToleranceRequest& request) {
  return request.intersector.empty() ? std::string(Exact::name) : request.intersector;
}

ToleranceChooser::ToleranceChooser(const SurfaceTruth& truth, const ToleranceRequest& request)
    : truth_(truth), request_(request) {
  if (!request.normals.empty()) normals_cost(request.normals); // throws
}

void ToleranceChooser::judge(Candidate& candidate) {
  const LevelSet& level_set = *candidate.level_set;
  candidate.world = request_.world(level_set);
  if (!(candidate.world > 0) || !std::isfinite(candidate.world))
    throw Error(ErrorKind::usage, "a tolerance must be a finite length > 0");
  candidate.choosing = rays_of(level_set, choosing_seed);
  candidate.judge.emplace(truth_, level_set, candidate.choosing->rays, candidate.choosing->places);
  const std::string name = best_intersector(request_);
  candidate.demonstrated = candidate.judge->errors(name, candidate.world).demonstrated();
  tried.push_back({candidate.voxel_size, name, candidate.half, candidate.world, candidate.demonstrated});
}

void ToleranceChooser::verify(Candidate& candidate) {
  if (candidate.verifier) return;
  candidate.verifying = rays_of(*candidate.level_set, verifying_seed);
  candidate.verifier.emplace(truth_, *candidate.level_set, candidate.verifying->rays,
                             candidate.verifying->places);
}

bool ToleranceChooser::settle(Candidate& candidate, const std::vector<std::string>& intersectors,
                              ToleranceResult& result) {
  verify(candidate);
  for (const std::string& name : intersectors) {
    const double by_choosing = candidate.judge->errors(name, candidate.world).demonstrated();
    if (tried.empty() || tried.back().intersector != name || tried.back().half != candidate.half ||
        tried.back().voxel_size != candidate.voxel_size)
      tried.push_back({candidate.voxel_size, name, candidate.half, candidate.world, by_choosing});
    if (!(by_choosing <= candidate.world)) continue;
    const SurfaceErrors errors = candidate.verifier->errors(name, candidate.world);
    if (!(errors.demonstrated() <= candidate.world)) continue;
    result.end = ToleranceEnd::met;
    result.voxel_size = candidate.voxel_size, result.world = candidate.world;
    result.intersector = name, result.half = candidate.half;
    result.achieved = achieved_by(errors);
    return true;
  }
  return false;
}

bool ToleranceChooser::settle_half(const BlockGrid& grid, ToleranceResult& result,
                                   std::unique_ptr<Candidate>& rounded) {
  if (!request_.stored || request_.half) return false;
  rounded = std::make_unique<Candidate>();
  rounded->voxel_size = grid.transform.voxel_size;
  if (!round_into(grid, *rounded)) return false;
  judge(*rounded);
  return settle(*rounded, {result.intersector}, result);
}

bool ToleranceChooser::round_into(const BlockGrid& grid, Candidate& candidate) {
  auto values = rounded_to_half(grid);
  if (!values) return false;
  candidate.converted.grid = std::move(*values);
  candidate.level_set.emplace(candidate.converted.grid);
  candidate.half = true;
  return true;
}

void ToleranceChooser::choose_normals(const Candidate& candidate, ToleranceResult& result) const {
  const double allowed = std::atan(result.world / result.voxel_size) * 180 / 3.14159265358979323846;
  double least = std::numeric_limits<double>::infinity();
  for (const std::string& name :
       request_.normals.empty() ? smooth_normals_by_cost() : std::vector<std::string>{request_.normals}) {
    const double angle = candidate.judge->normals_median_degrees(name);
    if (angle < least) result.normals = name, result.normals_median_degrees = least = angle;
    if (angle <= allowed) break;
  }
}

void ToleranceChooser::refuse(Candidate& candidate, ToleranceEnd end, ToleranceResult& result) {
  verify(candidate);
  const std::string name = best_intersector(request_);
  const SurfaceErrors errors = candidate.verifier->errors(name, candidate.world);
  result.end = end;
  result.voxel_size = candidate.voxel_size, result.world = candidate.world;
  result.intersector = name, result.half = candidate.half;
  result.achieved = achieved_by(errors);
  result.closest = std::max(candidate.demonstrated, result.achieved.demonstrated);
}

// Rays of a camera may depend on the grid, chords do not.
std::shared_ptr<const RaySet> ToleranceChooser::rays_of(const LevelSet& level_set, std::uint64_t seed) {
  if (request_.rays) return std::make_shared<RaySet>(draw_rays(truth_, request_, level_set, seed));
  std::shared_ptr<const RaySet>& kept = chords_[seed == verifying_seed];
  if (!kept) kept = std::make_shared<RaySet>(draw_rays(truth_, request_, level_set, seed));
  return kept;
}

} // namespace levelray
