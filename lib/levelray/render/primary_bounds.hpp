// Min/max buffers of all objects of a scene, for one camera.
#pragma once

#include "levelray/render/camera.hpp"
#include "levelray/render/scene_rays.hpp"

namespace levelray {

class PrimaryBounds {
 public:
  // Draws the buffers, resolution x resolution cells each (accel/minmax_buffer.hpp), in parallel. The same
  // for any number of threads.
  PrimaryBounds(const SceneRays& objects, const Camera& camera, int resolution);

  // What SceneRays::closest takes for the rays through image position (x,y), in pixels as Camera::ray has
  // them: sets bounds[object * rays + i] for every object.
  void look_up(double x, double y, std::size_t i, std::size_t rays, std::span<RayBounds> bounds) const;

 private:
  struct Buffer {
    MinMaxBuffer cells;
    double scale; // from the object's lengths to t of the camera's rays
  };
  double per_width_, per_height_;
  std::vector<Buffer> buffers_;
};

} // namespace levelray
