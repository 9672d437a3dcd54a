#include "levelray/render/shade.hpp"
#include "levelray/render/shading.hpp"

#include <cmath>

namespace levelray {

namespace {

// A light as one vertex sees it.
struct Incoming {
  Vec3d to_light;   // unit
  double intensity; // that of a directional light
  Vec3d direction;  // of the shadow ray
  double t_max;     // where it ends
};

Incoming incoming(const DirectionalLight& light, const Vertex&) {
  return {light.to_light, light.intensity, light.to_light, std::numeric_limits<double>::infinity()};
}

Incoming incoming(const PointLight& light, const Vertex& vertex) {
  const Vec3d way = light.position - vertex.point;
  const double squared = way.dot(way);
  if (!(squared > 0)) return {Vec3d(0, 0, 0), 0, Vec3d(0, 0, 0), 0}; // the light lies on the surface
  // The shadow ray has its light at t = 1 and ends before it: an object behind the light hides nothing, nor
  // does one whose surface the light lies on.
  const Vec3d direction = light.position - vertex.outside;
  return {way / std::sqrt(squared), light.intensity / squared, direction, std::nextafter(1.0, 0.0)};
}

// Adds one light to the vertices that face it and, with shadows, are not hidden from it.
template <class Light>
void add_light(Shading& shading, const Light& light, std::span<const Vertex> vertices,
               std::vector<Vec3d>& radiance) {
  std::vector<std::size_t> lit;
  std::vector<Vec3d> gain;
  std::vector<WorldRay> rays;
  lit.reserve(vertices.size());
  gain.reserve(vertices.size());
  const bool shadows = shading.shadows && light.casts_shadows;
  if (shadows) rays.reserve(vertices.size());
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const Vertex& v = vertices[i];
    const Incoming in = incoming(light, v);
    const Vec3d added = shade_light(*v.material, v.normal, in.to_light, v.back) * in.intensity * light.color;
    if (!(added.x > 0 || added.y > 0 || added.z > 0)) continue;
    lit.push_back(i);
    gain.push_back(added);
    if (!shadows) continue;
    // From the ray's last point that is proven to be outside: no offset, hence no acne and no leak.
    WorldRay& ray = rays.emplace_back();
    ray.origin = v.outside;
    ray.direction = in.direction;
    ray.t_max = in.t_max;
  }
  const std::unique_ptr<bool[]> hidden(new bool[lit.size()]());
  if (!rays.empty()) {
    // Either all of the light's rays are traced or none, so ray i is that of vertex lit[i].
    std::vector<RayCounts> counts(rays.size());
    shading.objects.any(rays, shading.intersector, std::span(hidden.get(), rays.size()), counts);
    CountSums sums;
    for (const RayCounts& own : counts) sums += own;
    shading.shadow_counts += sums;
    if (!shading.shadow_counts_of.empty())
      for (std::size_t i = 0; i < counts.size(); ++i)
        shading.shadow_counts_of[vertices[lit[i]].pixel] += counts[i];
  }
  shading.shadow_rays += rays.size();
  for (std::size_t i = 0; i < lit.size(); ++i)
    if (!hidden[i]) radiance[lit[i]] += gain[i];
}

bool is_diffuse(const Material& material) {
  return material.kind == MaterialKind::diffuse || material.kind == MaterialKind::phong;
}

} // namespace

std::vector<Vec3d> local_radiance(Shading& shading, std::span<const Vertex> vertices) {
  const Scene& scene = shading.scene;
  std::vector<Vec3d> radiance(vertices.size(), Vec3d(0, 0, 0));

  // Ambient and sky light, which mirrors and glass do not scatter.
  std::vector<Vertex> diffuse;
  std::vector<double> hidden;
  if (scene.ambient_occlusion.samples > 0) {
    for (const Vertex& v : vertices)
      if (is_diffuse(*v.material)) diffuse.push_back(v);
    hidden = occlusion(shading, diffuse);
  }
  std::size_t next = 0;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const Material& material = *vertices[i].material;
    if (!is_diffuse(material)) continue;
    const double seen = hidden.empty() ? 1 : 1 - hidden[next++];
    radiance[i] = (material.albedo * scene.ambient + material.albedo * scene.sky.radiance) * seen;
  }

  for (const DirectionalLight& light : scene.directional_lights)
    add_light(shading, light, vertices, radiance);
  for (const PointLight& light : scene.point_lights) add_light(shading, light, vertices, radiance);
  return radiance;
}

} // namespace levelray
