#include "levelray/render/shade.hpp"

#include "levelray/core/error.hpp"

#include <cmath>

namespace levelray {

const std::vector<std::string>& shading_names() {
  static const std::vector<std::string> names{"lambert", "phong"};
  return names;
}

Material shading_material(std::string_view name) {
  Material material;
  if (name == "phong")
    material.kind = MaterialKind::phong, material.specular = 0.18;
  else if (name != "lambert")
    throw Error(ErrorKind::usage, "unknown shading \"" + std::string(name) + "\"; choose lambert or phong");
  return material;
}

Vec3d shade_light(const Material& material, const Vec3d& normal, const Vec3d& to_light, const Vec3d& to_eye) {
  const double cosine = normal.dot(to_light);
  if (!(cosine > 0)) return Vec3d(0, 0, 0);
  const bool scatters = material.kind == MaterialKind::diffuse || material.kind == MaterialKind::phong;
  Vec3d radiance = scatters ? material.albedo * cosine : Vec3d(0, 0, 0);
  if (material.specular > 0 && material.kind != MaterialKind::diffuse) {
    const double mirrored = (normal * (2 * cosine) - to_light).dot(to_eye);
    if (mirrored > 0) radiance += Vec3d(material.specular * std::pow(mirrored, material.exponent));
  }
  return radiance;
}

} // namespace levelray
