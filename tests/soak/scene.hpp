// Shapes and rays of a soak: all that a chunk needs follows from its number and the seed.
#pragma once

#include "levelray/core/ray.hpp"
#include "levelray/grid/block_grid.hpp"
#include "levelray/trace/level_set.hpp"
#include "oracle/ray_oracle.hpp"

#include <array>
#include <cstdint>
#include <random>
#include <string_view>
#include <vector>

namespace levelray::test {

inline constexpr std::array<std::string_view, 12> shape_kinds{
    "fat sphere",  "tiny sphere", "thin torus",       "slab",  "shell",         "gyroid",
    "rotated box", "cone",        "touching spheres", "noise", "integer noise", "aligned box"};

inline constexpr std::array<std::string_view, 12> ray_kinds{
    "random",  "through a vertex", "through an edge",  "through a face", "along an axis", "diagonal",
    "tangent", "silhouette",       "from the surface", "in the box",     "cut interval",  "odd direction"};

using Random = std::mt19937_64;

double uniform(Random& random, double low, double high);

// A shape of that kind with random size, place, tilt and voxel size; some 40^3 to 60^3 samples.
BlockGrid random_shape(std::size_t kind, Random& random);

// Makes rays for a grid: random ones, and those that look for trouble; each of the latter is moved by 0 or 1
// unit in the last place of each coordinate half of the time.
class RayMaker {
 public:
  RayMaker(const LevelSet& level_set, const RayOracle& oracle, Random& random);
  WorldRay make(std::size_t kind);
  // A kind: a third of them random rays, few silhouettes, which take the oracle longest.
  std::size_t any_kind();

 private:
  Vec3d point_in_box();
  Vec3d direction();
  Vec3d near_surface(); // voxel coordinates of some point of the surface, if there is any
  WorldRay through(const Vec3d& world_point, const Vec3d& direction);
  void shake(Vec3d& v);
  WorldRay silhouette();

  const LevelSet& level_set_;
  const BlockGrid& grid_;
  Random& random_;
  Box3d box_; // world, of the active samples
  double reach_;
  std::vector<Vec3d> surface_; // world points on it
};

} // namespace levelray::test
