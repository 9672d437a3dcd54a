// How far the surfaces reach that an automatic camera has to see and an automatic ground lies under.
#pragma once

#include "levelray/grid/block_grid.hpp"
#include "levelray/render/camera.hpp"
#include "levelray/render/scene.hpp"

#include <array>
#include <vector>

namespace levelray {

class Framing {
 public:
  // For cameras of this size, field of view and up; eye and target do not matter. Throws Error(usage) for an
  // up without direction.
  explicit Framing(const CameraSettings& view);

  // One more surface to be seen; of a sequence, a frame.
  void add(const BlockGrid& grid);
  // The only surface, to be seen from everywhere on the camera's way round its middle.
  void add_turning(const BlockGrid& grid);

  // Sees all of them.
  CameraSettings camera() const;
  // Under the lowest of them, around the middle of all. Changes nothing where there is no surface.
  void place(GroundSettings& ground) const;

 private:
  CameraSettings view_;
  std::array<Vec3d, 4> directions_; // framing_directions of the view
  std::array<double, 4> support_;   // the surfaces' largest dot product with each
  Box3d bounds_;
  double lowest_; // along the unit up
};

// The frames that stand for a sequence, whose own surfaces nobody has seen yet: its first, middle and last.
std::vector<int> framing_frames(const std::vector<int>& frames);

} // namespace levelray
