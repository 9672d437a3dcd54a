#include "levelray/measure/tolerance.hpp"

#include "levelray/convert/thicken.hpp"
#include "levelray/core/error.hpp"
#include "levelray/core/parallel.hpp"
#include "levelray/measure/method_costs.hpp"
#include "levelray/measure/tolerance_chooser.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

namespace levelray {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// The search for a voxel size.
class VoxelSearch {
 public:
  VoxelSearch(const PreparedMesh& mesh, const ToleranceRequest& request)
      : mesh_(mesh), request_(request), truth_(mesh, request.convert.thicken), chooser_(truth_, request) {
    const Vec3d size = mesh.report.bounds.size();
    longest_ = std::max({size.x, size.y, size.z});
    largest_voxel_ = longest_ / 4;
    if (request.convert.thicken > 0)
      largest_voxel_ = std::min(largest_voxel_, 2 * request.convert.thicken / safe_thickness_voxels);
    // The finest that memory allows, by halving the logarithm.
    finest_ = std::max(request.least_voxel, longest_ * 0x1p-20);
    if (!fits(finest_)) {
      double too_fine = finest_, fine = largest_voxel_;
      while (fine / too_fine > 1.01) {
        const double middle = std::sqrt(fine * too_fine);
        (fits(middle) ? fine : too_fine) = middle;
      }
      finest_ = fine;
    }
  }

  ToleranceResult run() {
    ToleranceResult result;
    if (request_.fixed_voxel) {
      const auto candidate = at(plan_conversion(mesh_, request_.convert).voxel_size);
      if (!candidate) throw *empty_;
      if (!chooser_.settle(*candidate, intersectors_for(request_), result))
        chooser_.refuse(*candidate, ToleranceEnd::fixed, result);
      else
        finish(*candidate, result);
    } else {
      search(result);
    }
    result.tried = std::move(chooser_.tried);
    return result;
  }

 private:
  static constexpr int most_trials = 16;
  static constexpr double close_enough = 7.0 / 8, near_voxels = 13.0 / 12;
  static constexpr int finer_trials = 3;
  static constexpr double pays = 0.9; // the costs are not known better

  ConvertOptions options_for(double voxel_size) const {
    ConvertOptions options = request_.convert;
    options.voxel_size = voxel_size;
    if (request_.band > 0) options.half_width_voxels = std::max(1.0, request_.band / voxel_size);
    return options;
  }

  bool fits(double voxel_size) const {
    const ConvertOptions options = options_for(voxel_size);
    try {
      plan_conversion(mesh_, options);
    } catch (const Error& error) {
      if (error.kind() == ErrorKind::limit) return false;
      throw;
    }
    return true;
  }

  // Converts and judges; nothing where no volume is enclosed with such voxels.
  std::unique_ptr<Candidate> at(double voxel_size) {
    check_cancel();
    auto candidate = std::make_unique<Candidate>();
    candidate->voxel_size = voxel_size;
    const ConvertOptions options = options_for(voxel_size);
    try {
      candidate->converted = mesh_to_grid(mesh_, options);
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::bad_input) throw;
      empty_ = error;
      chooser_.tried.push_back({voxel_size, best_intersector(request_), false, request_.guess, infinity});
      return nullptr;
    }
    if (request_.half && *request_.half) {
      const BlockGrid grid = std::move(candidate->converted.grid);
      if (!chooser_.round_into(grid, *candidate))
        throw Error(ErrorKind::limit,
                    "distances do not fit 16-bit floats; scale the mesh down or write 32-bit ones");
    } else {
      candidate->level_set.emplace(candidate->converted.grid);
    }
    chooser_.judge(*candidate);
    return candidate;
  }

  // The order of the error between the last two trials that had one.
  double order() const {
    const ToleranceTrial *last = nullptr, *before = nullptr;
    for (auto trial = chooser_.tried.rbegin(); trial != chooser_.tried.rend() && !before; ++trial) {
      if (!std::isfinite(trial->demonstrated) || !(trial->demonstrated > 0)) continue;
      if (last && trial->voxel_size == last->voxel_size) continue;
      (last ? before : last) = &*trial;
    }
    if (!before) return 1;
    const double slope =
        std::log(last->demonstrated / before->demonstrated) / std::log(last->voxel_size / before->voxel_size);
    return std::clamp(slope, 0.7, 2.0);
  }

  // The voxel size whose error the model says to be a little below the tolerance.
  double predicted(double voxel_size, double error, double world) const {
    if (!std::isfinite(error)) return voxel_size / 2;
    if (!(error > 0)) return voxel_size * 4;
    return voxel_size * std::clamp(std::pow(0.94 * world / error, 1 / order()), 0.25, 4.0);
  }

  void search(ToleranceResult& result) {
    double voxel = std::clamp(3 * request_.guess, longest_ / 96, largest_voxel_);
    if (!(request_.guess > 0)) voxel = longest_ / 64;
    voxel = std::clamp(voxel, std::min(finest_, largest_voxel_), largest_voxel_);
    std::unique_ptr<Candidate> good, best; // best: of those that failed
    double failed = infinity;              // the smallest voxel that failed and is larger than the good one
    ToleranceEnd end = ToleranceEnd::unreachable;
    int without_surface = 0;
    for (int trial = 0; trial < most_trials; ++trial) {
      std::unique_ptr<Candidate> candidate = at(voxel);
      if (!candidate && ++without_surface == 6) break; // voxels of a 64th of the first, and still none
      const double world = candidate ? candidate->world : request_.guess;
      const double error = candidate ? candidate->demonstrated : infinity;
      if (candidate && error <= world) {
        good = std::move(candidate);
        if (good->demonstrated >= close_enough * world || voxel >= largest_voxel_) break;
      } else {
        failed = voxel;
        if (candidate && (!best || error <= best->demonstrated)) best = std::move(candidate);
      }
      if (good) {
        const double ratio = failed / good->voxel_size;
        if (ratio <= near_voxels) break;
        voxel = predicted(good->voxel_size, good->demonstrated, good->world);
        voxel = std::isfinite(failed) ? std::clamp(voxel, good->voxel_size * std::pow(ratio, 0.25),
                                                   good->voxel_size * std::pow(ratio, 0.75))
                                      : std::clamp(voxel, good->voxel_size * near_voxels, largest_voxel_);
        continue;
      }
      if (voxel <= finest_) {
        end = ToleranceEnd::limited;
        break;
      }
      if (world > 0 && voxel <= world / 8) break;
      voxel = std::max({std::min(predicted(voxel, error, world), 0.85 * voxel), finest_, world / 8});
    }
    best = good ? nullptr : std::move(best);

    // Verify, with finer voxels where the other rays disagree.
    for (int round = 0; good && round < 6; ++round) {
      if (good->demonstrated <= good->world && chooser_.settle(*good, intersectors_for(request_), result))
        return finish(*cheaper(std::move(good), result), result);
      if (good->voxel_size <= finest_) {
        end = ToleranceEnd::limited;
        break;
      }
      voxel = std::max(good->voxel_size * 0.93, finest_);
      best = std::move(good);
      good = at(voxel);
    }
    if (good) best = std::move(good);
    if (!best) throw *empty_;
    chooser_.refuse(*best, end, result);
  }

  // Of the conversion and the picture, by measured costs.
  double cost(const Candidate& candidate, const std::string& intersector) const {
    const CountSums counts = candidate.judge->counts();
    const auto rays = static_cast<double>(std::max<std::size_t>(candidate.choosing->rays.size(), 1));
    return conversion_cost_of(candidate) +
           request_.picture_rays * intersector_cost(intersector) *
               ray_cost(static_cast<double>(counts.steps) / rays, static_cast<double>(counts.tests) / rays);
  }
  static double conversion_cost_of(const Candidate& candidate) {
    return conversion_cost(static_cast<double>(candidate.converted.grid.active_sample_count()));
  }

  // Finer voxels than those of the settled candidate, where they pay.
  std::unique_ptr<Candidate> cheaper(std::unique_ptr<Candidate> chosen, ToleranceResult& result) {
    const double coarsest = chosen->voxel_size, conversion = conversion_cost_of(*chosen);
    double least = cost(*chosen, result.intersector);
    const double most_gain = 0.5 * (least - conversion);
    for (int trial = 1; trial <= finer_trials; ++trial) {
      const double voxel = coarsest * std::exp2(-trial / 6.0);
      const double more = conversion * (std::exp2(trial / 3.0) - 1);
      if (voxel < finest_ || more >= most_gain) break;
      std::unique_ptr<Candidate> candidate = at(voxel);
      ToleranceResult settled;
      if (!candidate || !(candidate->demonstrated <= candidate->world) ||
          !chooser_.settle(*candidate, intersectors_for(request_), settled))
        continue;
      const double costs = cost(*candidate, settled.intersector);
      if (costs > pays * least) continue;
      least = costs;
      chosen = std::move(candidate);
      result = std::move(settled);
    }
    return chosen;
  }

  void finish(Candidate& candidate, ToleranceResult& result) {
    chooser_.choose_normals(candidate, result);
    std::unique_ptr<Candidate> rounded;
    if (chooser_.settle_half(candidate.converted.grid, result, rounded))
      candidate.converted.grid = std::move(rounded->converted.grid);
    result.converted = std::move(candidate.converted);
  }

  const PreparedMesh& mesh_;
  const ToleranceRequest& request_;
  MeshTruth truth_;
  ToleranceChooser chooser_;
  double longest_ = 0, largest_voxel_ = 0, finest_ = 0;
  std::optional<Error> empty_; // what a conversion said that found nothing enclosed
};

} // namespace

ToleranceResult convert_to_tolerance(const PreparedMesh& mesh, const ToleranceRequest& request) {
  if (request.convert.sign == SignMethod::unsigned_distance)
    throw Error(
        ErrorKind::usage,
        "unsigned distances have no surface that rays meet, and so no tolerance; choose another sign");
  return VoxelSearch(mesh, request).run();
}

ToleranceResult trace_to_tolerance(const BlockGrid& grid, const ToleranceRequest& request) {
  const LevelSet truth_set(grid);
  GridTruth truth(truth_set);
  ToleranceChooser chooser(truth, request);
  ToleranceResult result;
  Candidate candidate;
  candidate.voxel_size = grid.transform.voxel_size;
  if (request.half && *request.half) {
    if (!chooser.round_into(grid, candidate))
      throw Error(ErrorKind::limit,
                  "distances do not fit 16-bit floats; scale the grid down or write 32-bit ones");
  } else {
    candidate.level_set.emplace(grid);
  }
  chooser.judge(candidate);
  if (!chooser.settle(candidate, intersectors_for(request), result)) {
    chooser.refuse(candidate, ToleranceEnd::fixed, result);
  } else {
    chooser.choose_normals(candidate, result);
    std::unique_ptr<Candidate> rounded;
    chooser.settle_half(grid, result, rounded);
  }
  result.tried = std::move(chooser.tried);
  return result;
}

} // namespace levelray
