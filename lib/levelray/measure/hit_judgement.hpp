// What is right or wrong about hits, against the shape that was sampled and against the grid's own surface.
//
// Against the shape. The grid's surface is another one: where it lies, the shape's value is no more than the
// interpolation error E (measure/reference.hpp), and where the interpolant is positive the value is above -E.
// So what follows from sampling alone, and no solver could help, is told apart ("unresolved"):
//  - a hit where the shape is missed is unresolved iff |value| <= E at the hit, else a phantom;
//  - a miss where the shape is hit is unresolved iff value >= -E all along the ray's first stretch in the
//  shape
//    (looked at in 257 places), else a leak;
//  - a hit behind that stretch is a wrong surface, or unresolved, by the same rule; so is one in front of it
//  by more
//    than a cell's diagonal, unresolved iff |value| <= E at the hit.
// All other hits have an error of t, which therefore includes the interpolation's: about E over the cosine
// between ray and normal.
//
// Against the grid's own surface, which the exact intersector finds: hits farther than a cell's diagonal,
// sqrt(3) voxels, from the exact one are on a wrong surface; those in the same cell never are.
#pragma once

#include "levelray/measure/error_statistics.hpp"
#include "levelray/measure/reference.hpp"
#include "levelray/trace/hit.hpp"

#include <cstdint>
#include <span>

namespace levelray {

struct Confusion {
  std::uint64_t hits = 0, misses = 0;               // both agree
  std::uint64_t leaks = 0, phantoms = 0, wrong = 0; // hit not found; found where there is none; another one
  std::uint64_t unresolved = 0;                     // of these kinds, but owed to sampling
  std::uint64_t undecided = 0;                      // rays about which the reference cannot tell

  std::uint64_t lost() const { return leaks + phantoms + wrong; }
  std::uint64_t rays() const { return hits + misses + lost() + unresolved + undecided; }
};

struct Judgement {
  Confusion confusion;
  std::vector<double> t_errors_voxels;        // of the hits, |t - reference| over the voxel size
  std::vector<double> distance_errors_voxels; // |value| of the shape at the hits; empty against the grid
};

// Rays have unit directions. `chords` are the shape's, one per ray.
Judgement judge_against_shape(const SampledReference& reference, std::span<const WorldRay> rays,
                              std::span<const Chord> chords, std::span<const Hit> hits);
Judgement judge_against_grid(double voxel_size, std::span<const Hit> exact, std::span<const Hit> hits);

// The angles in degrees between normals and the shape's at the hits: that of the surface point nearest to the
// hit, for fields that are distances. Misses have none.
std::vector<double> normal_errors_degrees(const Reference& shape, std::span<const WorldRay> rays,
                                          std::span<const Hit> hits, std::span<const Vec3f> normals);

} // namespace levelray
