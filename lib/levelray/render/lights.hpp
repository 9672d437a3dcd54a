// Directional lights.
#pragma once

#include "levelray/render/camera.hpp"

#include <vector>

namespace levelray {

struct DirectionalLight {
  Vec3d to_light{0, 0, 1};   // unit, from the surface towards the light
  double intensity = 1;      // a white surface of albedo 1 that faces the light has this radiance
  bool casts_shadows = true; // where shadows are asked for
};

// Key, fill and rim light that go along with the camera: key from the upper left, a weaker fill from the
// right, a rim light from behind above. Only the key light casts shadows.
std::vector<DirectionalLight> three_point_lights(const Camera& camera);

} // namespace levelray
