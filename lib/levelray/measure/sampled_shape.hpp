// A shape sampled at one resolution, with the rays that measure it and the answers that are right.
#pragma once

#include "levelray/measure/hit_judgement.hpp"
#include "levelray/render/camera.hpp"
#include "levelray/trace/level_set.hpp"

#include <algorithm>
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

// The shapes that the settings name, of all_references(). Throws Error(usage) for unknown ones, naming the
// known.
std::vector<Reference> chosen_references(const AnalyticSettings& settings);

// Holds references into itself, so it stays where it is.
class SampledShape {
 public:
  // `shape` must outlive it.
  SampledShape(const Reference& shape, int resolution, const AnalyticSettings& settings);
  SampledShape(const SampledShape&) = delete;
  SampledShape& operator=(const SampledShape&) = delete;

  const Reference& shape;
  const Sampling at;
  const BlockGrid grid;
  const LevelSet level_set;
  const SampledReference reference;
  const Camera camera;                         // sees all of the shape, square
  const std::vector<WorldRay> primary, chords; // the camera's, in the order of tiled_pixels; random ones
  std::vector<WorldRay> rays;                  // both, primary ones first
  std::vector<Chord> truth;                    // of the rays
  std::vector<Hit> exact;                      // of the rays, by the exact intersector
};

// Rays are traced in runs of that many, as the renderer does.
inline constexpr std::size_t ray_batch = 1024;
// Calls work(begin, count) for all runs.
template <class Work>
void in_batches(std::size_t count, Work&& work) {
  for (std::size_t begin = 0; begin < count; begin += ray_batch)
    work(begin, std::min(ray_batch, count - begin));
}

// Of errors in world units, or degrees, against the voxel size: the slopes of the logarithms' least squares.
struct Convergence {
  std::string shape, method, quantity; // "t", "distance" or "normal"
  bool smooth = true;                  // the shape
  std::vector<double> voxel_sizes, means, medians;
  double mean_slope = 0, median_slope = 0; // NaN where errors are 0 or there is one resolution
  double finest_slope =
      0; // of the means of the two smallest voxels alone, where thin parts are best resolved
};

// Curves, found by shape, method and quantity.
class ConvergenceCurves {
 public:
  void add(const Reference& shape, const std::string& method, const std::string& quantity, double voxel_size,
           double mean, double median);
  std::vector<Convergence> finish(); // with slopes, in the order of their first points

 private:
  std::vector<Convergence> curves_;
};

} // namespace levelray
