// Where along the rays through an image there can be surface at all: a pair of depth buffers of low
// resolution.
//
// Source: Jamriska 2010, section 6. Ours differs in being conservative. The paper draws a square of the width
// of the block's diagonal, divided by the depth of its centre, at the distance of its centre: that neither
// contains the projection of a turned block nor its near and far end. We draw the box of a block's surface
// cells, grown by the rounding of everything from here to the walk:
//  - its interval [x0,x1] along the image's horizontal axis, with depths in [z0,z1], z1 > 0, is seen within
//    slopes x0 / (x0 < 0 ? z0 : z1) to x1 / (x1 < 0 ? z1 : z0), and where z0 <= 0, z0 stands for 0 (so that a
//    box around the camera covers the image, and one beside it what it can); the same vertically. The
//    interval is c.right +- sum |right_a| e_a for half sizes e, which is tighter than the bounding sphere's
//    exact (cx cz +- r sqrt(cx^2 + cz^2 - r^2)) / (cz^2 - r^2) wherever a block is small against its
//    distance.
//  - its distances from the eye are those of its nearest point and of its farthest corner.
// The least and the largest of each buffer cell are kept, so the order of drawing does not matter and nothing
// is sorted, and any number of threads gives the same bytes.
//
// Any image position in a buffer cell is covered, not only pixel centres, so samples may be jittered. Rays
// whose cell is empty miss.
#pragma once

#include "levelray/accel/surface_blocks.hpp"

#include <algorithm>
#include <limits>
#include <vector>

namespace levelray {

// What a ray may meet lies in [near, far] along it, in units of its own t; near > far: nothing.
struct RayBounds {
  float near = -std::numeric_limits<float>::infinity(), far = std::numeric_limits<float>::infinity();
};

// Rays from `eye` through slopes u in [-half_width, half_width] along `right` and v in [-half_height,
// half_height] along `up`: direction forward + u right + v up. World space; the axes are orthonormal.
struct PinholeView {
  Vec3d eye, right, up, forward;
  double half_width = 1, half_height = 1;
  double skew = 0; // by how much the axes may be off from being orthonormal: lengths and dot products
};

class MinMaxBuffer {
 public:
  // resolution x resolution cells over the image, 1 .. 4096.
  MinMaxBuffer(const SurfaceBlocks& surface, const GridTransform& transform, const PinholeView& view,
               int resolution);

  // For the ray of unit direction through image position (x,y), from (0,0) at the top left to (1,1), in world
  // units from the eye.
  RayBounds at(double x, double y) const {
    return cells_[cell(y) * static_cast<std::size_t>(resolution_) + cell(x)];
  }

  int resolution() const { return resolution_; }
  const std::vector<RayBounds>& cells() const { return cells_; } // rows from the top

 private:
  std::size_t cell(double x) const {
    const double i = x * resolution_;
    return i > 0 ? std::min(static_cast<std::size_t>(i), static_cast<std::size_t>(resolution_ - 1)) : 0;
  }

  int resolution_;
  std::vector<RayBounds> cells_;
};

} // namespace levelray
