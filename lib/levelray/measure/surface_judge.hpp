// How far the surface that rays find of a level set is from the one that it stands for, both ways.
//
// A ray's error is the larger of
//  - the distance of its hit from the truth: what is there should not be there;
//  - the distance of the truth's first place on the ray from the grid's surface: what should be there is not.
// The second is what shows a fin that fell between the samples: rays go through it and hit something that is
// right. An intersector that sees none of a surface that the grid has, or only another one behind it, loses
// the ray: its error is infinite.
//
// What is promised is a quantile, 99.9 %, and not the maximum: rays drawn at random can demonstrate that at
// most a thousandth of all rays has a larger error, and never that none has. At creases the interpolant of an
// exact distance field is off by a share of a voxel, and the tip of that share is seen by few rays of many.
#pragma once

#include "levelray/measure/surface_truth.hpp"
#include "levelray/trace/hit.hpp"

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace levelray {

// The share of rays whose error may exceed a tolerance.
inline constexpr double tolerated_share = 0.001;

// The errors of rays, world units.
struct SurfaceErrors {
  std::vector<double> errors; // of the rays with a hit or a first place, ascending; lost ones infinite
  std::uint64_t lost = 0;
  std::uint64_t not_judged = 0; // hits on what closes a hole of the mesh

  std::size_t rays() const { return errors.size(); }
  double quantile() const; // the smallest error that all but the tolerated share do not exceed
  double largest() const;  // of those that are not lost
  // The smallest tolerance that these errors demonstrate: fewer of them exceed it than chance would give, but
  // for 1 in 40 such samples, if more than the tolerated share of all rays did. Infinite where there are too
  // few (below 3689) and one is lost; of too few, the largest.
  double demonstrated() const;
};

// The largest k for which a Poisson variable with the mean count * tolerated_share is at most k with
// probability 1/40 or less; -1 where even 0 is likelier.
std::int64_t allowed_exceedances(std::size_t count);

// One grid and one set of rays with unit directions.
class SurfaceJudge {
 public:
  // Keeps references. `places` are the truth's on the rays (first_places).
  SurfaceJudge(const SurfaceTruth& truth, const LevelSet& level_set, std::span<const WorldRay> rays,
               std::span<const std::optional<TruePlace>> places);

  // Of the intersector with that name. `tolerance`, world units: a hit where the ray leaves the surface that
  // it should enter loses the ray if it is so far from the exact one.
  SurfaceErrors errors(std::string_view intersector, double tolerance) const;

  // Of all rays by `exact`, sums.
  CountSums counts() const;

  // The median angle in degrees between a scheme's normals and the truth's at the exact hits, of 4096 of the
  // rays at most; 0 where nothing is hit.
  double normals_median_degrees(std::string_view scheme) const;

 private:
  const SurfaceTruth& truth_;
  const LevelSet& level_set_;
  const std::span<const WorldRay> rays_;
  const std::span<const std::optional<TruePlace>> places_;
  std::vector<Hit> exact_;
  std::vector<double> from_truth_; // of the places; 0 where there is none
};

std::vector<std::optional<TruePlace>> first_places(const SurfaceTruth& truth, std::span<const WorldRay> rays);

} // namespace levelray
