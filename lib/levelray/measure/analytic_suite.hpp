// The suite `analytic`: every shape of field/reference_shapes.hpp, at several resolutions, by every
// intersector, normal scheme and acceleration of the lists.
#pragma once

#include "levelray/measure/hit_judgement.hpp"

#include <functional>
#include <string>
#include <vector>

namespace levelray {

struct AnalyticSettings {
  std::vector<int> resolutions{32, 64, 128, 256}; // N: voxels of 1/N
  std::vector<std::string> shapes;                // names; empty: all
  double half_width_voxels = 3;
  int image_size = 96;       // image_size^2 primary rays
  std::size_t chords = 8192; // random ones
  std::uint64_t seed = 1;
  int repetitions = 3; // of timings; 0: none
};

// What all rows say of themselves: a shape sampled at a resolution.
struct Sampling {
  std::string shape;
  int resolution = 0;
  double voxel_size = 0;
};

struct SolverRow {
  Sampling at;
  std::string method;
  Confusion shape, grid;                             // against the shape; against the grid's own surface
  ErrorStatistics t, distance, grid_t;               // voxels; `grid_t` against the grid's own surface
  double steps = 0, samples = 0, interpolations = 0; // per hit, those of misses included
  double primary_ns = 0, chord_ns = 0;               // per ray, medians
};

struct NormalRow {
  Sampling at;
  std::string method;
  ErrorStatistics degrees;                        // at the exact intersector's hits
  double samples = 0, interpolations = 0, ns = 0; // per hit
};

struct AccelerationRow {
  Sampling at;
  std::string method, rays;    // "primary", "chords", "shadow"
  std::uint64_t different = 0; // answers that are not the first row's bit for bit, over all intersectors
  double steps = 0, tests = 0, ns = 0; // per ray, with the exact intersector
};

// Of errors in world units, or degrees, against the voxel size: the slopes of the logarithms' least squares.
struct Convergence {
  std::string shape, method, quantity; // "t", "distance" or "normal"
  bool smooth = true;                  // the shape
  std::vector<double> voxel_sizes, means, medians;
  double mean_slope = 0, median_slope = 0; // NaN where errors are 0 or there is one resolution
};

struct AnalyticResult {
  std::vector<Sampling> samplings;
  std::vector<SolverRow> solvers;
  std::vector<NormalRow> normals;
  std::vector<AccelerationRow> accelerations;
  std::vector<Convergence> convergence;
  std::size_t primary_rays = 0, chords = 0;
};

// Throws Error(usage) for unknown shapes, naming the known ones. `progress` gets the fraction done. Uses one
// thread but for sampling.
AnalyticResult run_analytic_suite(
    const AnalyticSettings& settings, const std::function<void(double)>& progress = [](double) {});

} // namespace levelray
