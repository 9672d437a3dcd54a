// A pinhole camera. Pixel (0,0) is the top left one; rays pass through pixel centres.
#pragma once

#include "levelray/core/ray.hpp"

#include <array>

namespace levelray {

struct CameraSettings {
  Vec3d eye{0, 0, 5}, target{0, 0, 0}, up{0, 1, 0}; // world units
  double fov_degrees = 45;                          // vertical, in (0,180)
  int width = 512, height = 512;                    // pixels, 1 .. 65536 each
};

class Camera {
 public:
  // Throws Error(usage) when eye and target coincide, up is parallel to the view, or fov or size are out of
  // range.
  explicit Camera(const CameraSettings& settings);

  // The ray through image position (x,y) in pixels, pixel (0,0) spanning [0,1)^2 from the top left: a centre
  // is (i+0.5, j+0.5). Unit direction, so t is a length in world units.
  WorldRay ray(double x, double y) const;

  const CameraSettings& settings() const { return settings_; }
  Vec3d right() const { return right_; }
  Vec3d up() const { return up_; }
  Vec3d forward() const { return forward_; }          // unit, along the view axis
  double half_height() const { return half_height_; } // of the image at unit distance: tan(fov/2)

  // The matrices of the OpenEXR convention (StandardAttributes): row vectors; camera space left-handed, x
  // right, y up, z along the view; NDC from (0,0) top left to (1,1) bottom right of the image, after division
  // by w.
  Matrix44d world_to_camera() const;
  Matrix44d world_to_ndc() const;

 private:
  CameraSettings settings_;
  Vec3d right_, up_, forward_; // orthonormal; left-handed in this order, as seen through the lens
  double half_height_;         // tan(fov/2): half the image's height at unit distance
};

// The directions d along which framing_camera has to know an object: the largest dot(p, d) of its points p,
// which is called its support. They depend on the view alone. Throws Error(usage) for an `up` without
// direction.
std::array<Vec3d, 4> framing_directions(int width, int height, double fov_degrees, const Vec3d& up);

// A camera that looks at `centre` from the front, slightly right and above, and sees all of the object, as
// large as fits into 95% of the image. `up` points up in the picture; the front is +z when y is up and -y
// when z is up (the conventions of modelling programs). Objects of no extent are seen from a distance of 1.
// Throws Error(usage) for an `up` without direction.
CameraSettings framing_camera(const std::array<double, 4>& support, const Vec3d& centre, int width,
                              int height, double fov_degrees = 45, const Vec3d& up = Vec3d(0, 1, 0));
// The same of a box.
CameraSettings framing_camera(const Box3d& bounds, int width, int height, double fov_degrees = 45,
                              const Vec3d& up = Vec3d(0, 1, 0));

} // namespace levelray
