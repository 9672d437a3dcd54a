// Grids that are tried for a tolerance, and what is chosen for one of them: the part of measure/tolerance.hpp
// that meshes and grids share.
#pragma once

#include "levelray/measure/surface_judge.hpp"
#include "levelray/measure/tolerance.hpp"

#include <limits>
#include <memory>

namespace levelray {

// Rays of one seed, with the places where they first meet the truth.
struct RaySet {
  std::vector<WorldRay> rays;
  std::vector<std::optional<TruePlace>> places;
};

// A grid that was tried.
struct Candidate {
  ConvertedGrid converted;
  std::optional<LevelSet> level_set;
  double voxel_size = 0, world = 0;
  bool half = false;
  std::shared_ptr<const RaySet> choosing, verifying;
  std::optional<SurfaceJudge> judge, verifier;
  double demonstrated = std::numeric_limits<double>::infinity(); // by the choosing rays
};

// The intersectors to choose from, cheapest first; throws Error(usage) for one that is asked for and unknown.
std::vector<std::string> intersectors_for(const ToleranceRequest& request);
// The one to find voxels with.
std::string best_intersector(const ToleranceRequest& request);

class ToleranceChooser {
 public:
  // Keeps references. Throws Error(usage) for unknown normals.
  ToleranceChooser(const SurfaceTruth& truth, const ToleranceRequest& request);

  std::vector<ToleranceTrial> tried;

  // Judges the candidate's level set by the choosing rays.
  void judge(Candidate& candidate);
  // Takes the cheapest intersector that both sets of rays accept; false where there is none.
  bool settle(Candidate& candidate, const std::vector<std::string>& intersectors, ToleranceResult& result);
  // Takes storage with 16-bit floats where that is free to be chosen and does no harm; `rounded` is the grid
  // as it is then. `result` is settled.
  bool settle_half(const BlockGrid& grid, ToleranceResult& result, std::unique_ptr<Candidate>& rounded);
  // Makes the candidate's level set of a grid's values as 16-bit floats; false where they do not fit.
  static bool round_into(const BlockGrid& grid, Candidate& candidate);
  // Takes the cheapest smooth normals whose median angle is what the tolerance allows, else the best of them.
  void choose_normals(const Candidate& candidate, ToleranceResult& result) const;
  // What a candidate that failed achieves, and the tolerance that it would meet.
  void refuse(Candidate& candidate, ToleranceEnd end, ToleranceResult& result);

 private:
  void verify(Candidate& candidate);
  std::shared_ptr<const RaySet> rays_of(const LevelSet& level_set, std::uint64_t seed);

  const SurfaceTruth& truth_;
  const ToleranceRequest& request_;
  std::shared_ptr<const RaySet> chords_[2]; // of the two seeds
};

} // namespace levelray
