#include "levelray/render/scene.hpp"

#include "levelray/core/error.hpp"

#include <cmath>
#include <string>

namespace levelray {

namespace {

bool all_in(const Vec3d& v, double low, double high) {
  return v.x >= low && v.x <= high && v.y >= low && v.y <= high && v.z >= low && v.z <= high;
}

void require(bool legal, const std::string& what, const char* must) {
  if (!legal) throw Error(ErrorKind::usage, what + " must " + must);
}

constexpr double largest = std::numeric_limits<double>::max();

void check_material(const Material& m, const std::string& owner) {
  require(all_in(m.albedo, 0, 1), owner + ": albedo", "be within [0,1]");
  require(all_in(m.tint, 0, 1), owner + ": tint", "be within [0,1]");
  require(m.specular >= 0 && m.specular <= largest, owner + ": specular", "be finite and at least 0");
  require(m.exponent >= 0 && m.exponent <= largest, owner + ": exponent", "be finite and at least 0");
  require(m.ior > 0 && m.ior <= 1e6, owner + ": ior", "be within (0,1e6]");
}

template <class Light>
void check_light(const Light& light, const std::string& what) {
  require(light.intensity >= 0 && light.intensity <= largest, what + ": intensity",
          "be finite and at least 0");
  require(all_in(light.color, 0, largest), what + ": color", "be finite and at least 0");
}

} // namespace

void check_scene(const Scene& scene) {
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    const Instance& instance = scene.instances[i];
    const std::string owner = "object " + std::to_string(i + 1);
    require(instance.grid != nullptr, owner, "have a grid");
    require(instance.id <= largest_id, owner + ": id", "be at most 16777215");
    check_similarity(instance.world_from_object);
    check_material(instance.material, owner);
  }
  for (std::size_t i = 0; i < scene.directional_lights.size(); ++i) {
    const std::string what = "light " + std::to_string(i + 1);
    require(std::abs(scene.directional_lights[i].to_light.length() - 1) < 1e-9, what + ": direction",
            "have unit length");
    check_light(scene.directional_lights[i], what);
  }
  for (std::size_t i = 0; i < scene.point_lights.size(); ++i) {
    const std::string what = "point light " + std::to_string(i + 1);
    require(all_in(scene.point_lights[i].position, -largest, largest), what + ": position", "be finite");
    check_light(scene.point_lights[i], what);
  }
  require(scene.ambient >= 0 && scene.ambient <= largest, "ambient", "be finite and at least 0");
  require(all_in(scene.sky.radiance, 0, largest), "sky: radiance", "be finite and at least 0");
  if (const auto& ground = scene.ground) {
    require(ground->up.length() > 0 && ground->up.length() <= largest, "ground: up", "have a direction");
    require(!ground->height || std::isfinite(*ground->height), "ground: height", "be finite");
    require(!ground->centre || all_in(*ground->centre, -largest, largest), "ground: centre", "be finite");
    require(!ground->radius || (*ground->radius > 0 && *ground->radius <= largest), "ground: radius",
            "be finite and above 0");
    require(ground->id <= largest_id, "ground: id", "be at most 16777215");
    require(ground->material.kind != MaterialKind::glass, "ground: material",
            "be diffuse, phong or mirror: a plane has no inside");
    check_material(ground->material, "ground");
  }
  const AmbientOcclusion& occlusion = scene.ambient_occlusion;
  require(occlusion.samples >= 0 && occlusion.samples <= 65536, "ambient occlusion: samples",
          "be within 0 and 65536");
  require(occlusion.radius > 0, "ambient occlusion: radius", "be above 0");
  require(scene.max_depth >= 0 && scene.max_depth <= 64, "max_depth", "be within 0 and 64");
}

} // namespace levelray
