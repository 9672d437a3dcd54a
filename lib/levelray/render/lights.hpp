// Lights without extent: shadows are hard.
#pragma once

#include "levelray/render/camera.hpp"

#include <vector>

namespace levelray {

struct DirectionalLight {
  Vec3d to_light{0, 0, 1};   // unit, from the surface towards the light
  double intensity = 1;      // a white surface of albedo 1 that faces the light has this radiance
  bool casts_shadows = true; // where shadows are asked for
  Vec3d color{1, 1, 1};      // a factor, >= 0
};

// Radiates alike in all directions: as a directional light of intensity / distance^2 does (the inverse square
// law), so a white surface that faces it from a distance of one world unit has a radiance of `intensity`.
struct PointLight {
  Vec3d position{0, 0, 0}; // world units
  double intensity = 1;
  bool casts_shadows = true; // of what is nearer than the light
  Vec3d color{1, 1, 1};
};

// Key, fill and rim light that go along with the camera: key from the upper left, a weaker fill from the
// right, a rim light from behind above. Only the key light casts shadows.
std::vector<DirectionalLight> three_point_lights(const Camera& camera);

} // namespace levelray
