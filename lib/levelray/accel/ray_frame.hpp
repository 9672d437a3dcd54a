// A world-space ray made ready for traversal.
//
// The frame has its origin in a corner of the box of surface nodes, unit = voxel, and axes mirrored so that
// no component of the direction is negative: coordinates of the box run from 0 to 16 * dims, and a ray enters
// cells by their lower faces. The ray's parameter s is 0 where tracing begins, and is scaled by a power of
// two so that the largest component of the direction lies in [1,2).
#pragma once

#include "levelray/accel/surface_blocks.hpp"
#include "levelray/core/ray.hpp"

namespace levelray {

struct RayFrame {
  double origin[3];    // at s = 0
  double direction[3]; // >= 0
  double inverse[3];   // 1 / max(direction, 2^-100): never infinite, so that a plane through the origin is
                       // crossed at 0 and not at NaN, and other planes of a parallel ray are 2^47 voxels away
                       // at the least
  double end;          // the last s, >= 0; up to 1 beyond the box
  double t_at_start;   // t = t_at_start + s * t_per_s
  double t_per_s;
  int octant;            // bit a: axis a is mirrored
  int start_node[3];     // where the walk begins, in the frame's nodes: that which holds the origin, or one
                         // behind empty ones
  double start;          // s there
  double last;           // <= end: beyond it the ray meets no surface cell
  std::uint32_t skipped; // steps taken from the origin to there
  bool from_outside; // s = 0 lies on the box's hull, where every sample is positive: the ray came in there

  double t(double s) const { return t_at_start + s * t_per_s; }
};

// Returns false where the ray does not meet the box in [t_min, t_max], has no direction, or holds a NaN.
//
// Everything is computed in double. Moving the origin to the box costs half an ulp of |origin| and of the
// distance travelled: 1e-13 voxel for a camera 1000 voxels away, 1e-4 voxel for one 10^12 voxels away.
bool enter_box(const SurfaceBlocks& surface, const GridTransform& transform, const WorldRay& ray,
               RayFrame& frame);

} // namespace levelray
