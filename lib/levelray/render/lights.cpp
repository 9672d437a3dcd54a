#include "levelray/render/lights.hpp"

namespace levelray {

std::vector<DirectionalLight> three_point_lights(const Camera& camera) {
  const Vec3d right = camera.right(), up = camera.up(), back = -camera.forward();
  return {{(back * 0.75 + up * 0.75 - right * 0.65).normalized(), 0.85},
          {(back * 0.85 + up * 0.1 + right * 0.9).normalized(), 0.28, false},
          {(back * -0.6 + up * 0.85 + right * 0.25).normalized(), 0.35, false}};
}

} // namespace levelray
