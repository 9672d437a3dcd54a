// Rays through one grid, each judged in every way there is.
#pragma once

#include "levelray/measure/extremes.hpp"
#include "levelray/measure/ray_judge.hpp"
#include "levelray/trace/all_hits.hpp"
#include "levelray/trace/level_set.hpp"

#include <random>
#include <string>
#include <vector>

namespace levelray {

// For a grid that stays as it is and outlives it. Errors are in voxels. `surface_rays`: random rays that look
// for places on the surface, which others are aimed at.
class RayTrial {
 public:
  RayTrial(const BlockGrid& grid, std::string name, const ExtremeSettings& settings, ExtremeTally& tally,
           double rounding = 1, int surface_rays = 400);

  const BlockGrid& grid() const { return grid_; }
  const LevelSet& level_set() const { return level_set_; }
  const RayJudge& judge() const { return judge_; }
  // Of the clear hits' t, nearest first of all that random rays meet; empty where there is no surface.
  const std::vector<Vec3d>& surface() const { return surface_; }

  // Judges, of this ray:
  //  - that there is a hit exactly where one is owed, its t within the interval and within what rounding
  //    allows of the first root (2^-36 voxel for the solver, the documented rounding of values and places,
  //    eight units in the last place of t); any_hit says the same;
  //  - that f has the beginning's side at t_outside, in exact numbers, as far as hit.hpp promises it;
  //  - of all_hits: order, the first place's equality with the hit, and that the parity of crossings is the
  //    change of sign between the ends;
  //  - of certify: f(t_lo) > 0 >= f(t_hi) in exact numbers, the bound of the error, no refutation;
  //  - of every other intersector: that t is a number in the interval and that any_hit agrees.
  // Only the first two, and the last, of other intersectors than `exact`.
  void judge(const WorldRay& ray);
  // The same for the hits of `count` rays of each kind: random ones through the grid, along axes and
  // diagonals of the lattice, through its vertices, edges and faces near the surface, tangents, from inside,
  // from the surface, and cut off at it; every third moved by units in the last place.
  void judge_all_kinds(std::size_t count);
  // That nothing at all is found, as for what is no ray.
  void judge_nothing(const WorldRay& ray);

  // Leaves out t_outside, which is not promised where neighbouring blocks' samples differ wildly (hit.hpp).
  void without_safe_places() { safe_places_ = false; }

  // A random ray from outside through the band.
  WorldRay random_ray();
  double uniform(double low, double high);
  Vec3d random_direction();
  Vec3d random_place(); // in the band's box, world space

  // With numbers in hexadecimal.
  std::string describe(const WorldRay& ray) const;

 private:
  WorldRay ray_of_kind(int kind);
  void judge_places(const WorldRay& ray, const Hit& hit, const RayAnswer& answer);
  void judge_certificate(const WorldRay& ray, const Hit& hit, const RayAnswer& answer);
  void judge_others(const WorldRay& ray);

  const BlockGrid& grid_;
  std::string name_;
  const ExtremeSettings& settings_;
  ExtremeTally& tally_;
  LevelSet level_set_;
  RayJudge judge_;
  std::mt19937_64 random_;
  Box3d box_;
  std::vector<Vec3d> surface_;
  bool safe_places_ = true;
};

} // namespace levelray
