// On which side of the surface a ray begins.
#pragma once

#include "levelray/accel/ray_frame.hpp"
#include "levelray/grid/cell_segment.hpp"

namespace levelray {

// Known where the ray comes in through the hull of the box, else decided by the first surface cell on its
// way, at whose beginning the value still has the sign of the ray's beginning (cells without the bit do not
// change it). On the surface itself it is the outside: it is hit there.
class StartingSide {
 public:
  explicit StartingSide(const RayFrame& ray) : side_(ray.from_outside ? 1 : 0) {}

  double at_first(const CellSegment& segment) {
    if (side_ == 0) side_ = interpolate(segment.corner, segment.in) < 0 ? -1 : 1;
    return side_;
  }
  bool known() const { return side_ != 0; }
  bool inside() const { return side_ < 0; }
  int interpolations() const { return !known(); } // that the first cell will take

 private:
  double side_;
};

} // namespace levelray
