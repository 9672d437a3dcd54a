// The suite `analytic`: every shape of field/reference_shapes.hpp, at several resolutions, by every
// intersector, normal scheme and acceleration of the lists.
#pragma once

#include "levelray/measure/sampled_shape.hpp"

#include <functional>
#include <string>
#include <vector>

namespace levelray {

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
