// Cameras that a renderer may meet: in front, inside, grazing, behind, very wide, very far, along axes.
#pragma once

#include "levelray/render/camera.hpp"
#include "support/trace_fixtures.hpp"

namespace levelray::test {

// Around an object with bounds `box`. The kinds take turns with `number`.
inline CameraSettings random_camera(RandomRays& random, const Box3d& box, int number, int width, int height) {
  const Vec3d centre = (box.min + box.max) * 0.5;
  const double size = (box.max - box.min).length();
  CameraSettings camera;
  camera.width = width, camera.height = height;
  camera.fov_degrees = random.uniform(15, 80);
  camera.up = random.direction();
  camera.target = random.in_box(box);
  camera.eye = centre + random.direction() * size * random.uniform(0.6, 3);
  switch (number % 8) {
  case 1:
    camera.eye = random.in_box(box);
    break; // inside the box, often inside the object
  case 2:  // along a face of the box
    camera.eye = random.in_box(box);
    camera.eye[number / 8 % 3] = number % 16 < 8 ? box.min[number / 8 % 3] : box.max[number / 8 % 3];
    camera.target = camera.eye + random.direction();
    camera.target[number / 8 % 3] = camera.eye[number / 8 % 3];
    break;
  case 3:
    camera.target = camera.eye + (camera.eye - centre) + random.direction() * size;
    break; // away
  case 4:  // very wide, near or inside
    camera.fov_degrees = random.uniform(140, 179.9);
    camera.eye = centre + random.direction() * size * random.uniform(0, 0.7);
    break;
  case 5: { // very far
    const double far = std::pow(10, random.uniform(1, 9));
    camera.eye = centre + random.direction() * size * far;
    camera.target = centre;
    camera.fov_degrees = std::min(30.0, 80 / far);
    break;
  }
  case 6: { // along an axis, from a lattice point: ties
    const int axis = number / 8 % 3;
    for (int a = 0; a < 3; ++a) camera.target[a] = std::round(camera.target[a]);
    camera.eye = camera.target;
    camera.eye[axis] += std::round(size) * (number % 16 < 8 ? 1 : -1);
    camera.up = Vec3d(0, 0, 0);
    camera.up[(axis + 1) % 3] = 1;
    camera.fov_degrees = 90;
    break;
  }
  default:
    break;
  }
  return camera;
}

} // namespace levelray::test
