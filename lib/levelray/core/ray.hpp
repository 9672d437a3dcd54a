// Rays, whose type names the space they live in.
#pragma once

#include "levelray/core/vec.hpp"

#include <limits>

namespace levelray {

// Points o + t d with t in [t_min, t_max], in world units or in voxel units (sample i at coordinate i). `t`
// multiplies the ray's own direction, which need not have unit length, so t is the same number in either
// space.
template <class Space>
struct BasicRay {
  Vec3d origin{0, 0, 0};
  Vec3d direction{0, 0, 1};
  double t_min = 0;
  double t_max = std::numeric_limits<double>::infinity();

  Vec3d at(double t) const { return origin + direction * t; }
};

struct WorldSpace {};
struct VoxelSpace {};
using WorldRay = BasicRay<WorldSpace>;
using VoxelRay = BasicRay<VoxelSpace>;

} // namespace levelray
