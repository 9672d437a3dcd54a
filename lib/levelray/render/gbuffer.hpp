// What the rays through an image's pixels found: the waist between finding hits and using them.
#pragma once

#include "levelray/core/uninitialized_vector.hpp"
#include "levelray/trace/hit.hpp"

namespace levelray {

enum class PixelStatus : std::uint8_t {
  miss,    // nothing; of the other values only the counts are set
  surface, // an object, entered from outside
  inner,   // an object, left from inside: the camera stands in it
  ground   // the ground plane
};

// Per pixel, rows from the top. Accuracy is measured here, never on shaded pixels.
struct GBuffer {
  int width = 0, height = 0;

  uninitialized_vector<PixelStatus> status;
  uninitialized_vector<double> t;      // world units along the ray's unit direction
  uninitialized_vector<Vec3d> point;   // world units: the ray's point at t
  uninitialized_vector<Vec3d> outside; // world units: the ray's last point proven to lie before the surface,
                                       // where secondary rays start
  uninitialized_vector<Vec3f> normal;  // unit, outward (towards the positive side); never NaN
  uninitialized_vector<std::int32_t> object; // index of the instance that was hit; -1: none
  uninitialized_vector<RayCounts> counts;

  // Bytes that a pixel takes.
  static constexpr std::size_t bytes_per_pixel = sizeof(PixelStatus) + sizeof(double) + 2 * sizeof(Vec3d) +
                                                 sizeof(Vec3f) + sizeof(std::int32_t) + sizeof(RayCounts);

  // Values are undefined until written.
  void resize(int new_width, int new_height) {
    width = new_width;
    height = new_height;
    const std::size_t n = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    status.resize(n);
    t.resize(n);
    point.resize(n);
    outside.resize(n);
    normal.resize(n);
    object.resize(n);
    counts.resize(n);
  }
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  }
};

} // namespace levelray
