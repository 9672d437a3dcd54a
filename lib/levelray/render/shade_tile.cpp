// A tile's paths, in waves: all vertices of one depth are shaded together, then all rays that go on from them
// are traced together.
#include "levelray/render/random.hpp"
#include "levelray/render/surface_place.hpp"

#include <algorithm>
#include <cmath>

namespace levelray {

namespace {

// A ray of which less than this arrives at the eye is not traced but sees the sky: the picture is off by no
// more than this part of the difference, a sixteenth of a step of an 8-bit picture for radiances up to 1.
constexpr double least_weight = 0x1p-12;

const Material& material_of(const Shading& shading, int object) {
  return object == SceneRays::nothing ? shading.scene.ground->material
                                      : shading.objects.object(object).instance->material;
}

// What `length` world units in glass let through (Bouguer, Lambert, Beer).
Vec3d transmittance(const Vec3d& tint, double length) {
  return Vec3d(std::pow(tint.x, length), std::pow(tint.y, length), std::pow(tint.z, length));
}

// The vertices of what primary rays found.
std::vector<Vertex> first_vertices(Shading& shading, const Tile& tile, const GBuffer& gbuffer, int sample,
                                   std::vector<std::size_t>& pixels) {
  std::vector<Vertex> vertices;
  const auto most = static_cast<std::size_t>((tile.x_end - tile.x_begin) * (tile.y_end - tile.y_begin));
  vertices.reserve(most);
  pixels.reserve(most);
  const std::uint64_t salt = mix_hash(shading.seed, static_cast<std::uint64_t>(sample));
  std::uint64_t hits = 0;
  for (int y = tile.y_begin; y < tile.y_end; ++y)
    for (int x = tile.x_begin; x < tile.x_end; ++x) {
      const std::size_t i = gbuffer.index(x, y);
      const PixelStatus status = gbuffer.status[i];
      if (status == PixelStatus::miss) continue;
      const bool on_ground = status == PixelStatus::ground;
      Vertex& v = vertices.emplace_back();
      v.root = pixels.size();
      v.pixel = i;
      pixels.push_back(i);
      v.branch = salt + i; // hashed wherever it is used
      v.depth = 0;
      v.object = gbuffer.object[i];
      v.inner = status == PixelStatus::inner;
      v.material = &material_of(shading, v.object);
      v.coverage = on_ground ? shading.ground->coverage(gbuffer.point[i]) : 1;
      v.weight = Vec3d(1, 1, 1);
      v.point = gbuffer.point[i];
      v.outside = gbuffer.outside[i];
      v.normal = Vec3d(gbuffer.normal[i]);
      if (v.inner) {
        v.normal = -v.normal; // seen from behind
        if (v.material->kind == MaterialKind::glass) v.weight = transmittance(v.material->tint, gbuffer.t[i]);
      }
      v.back = (shading.eye - v.point).normalized();
      if (!on_ground) check_safe_point(shading.objects.object(v.object), v);
      hits += on_ground ? 0 : 1;
    }
  shading.hits += hits;
  return vertices;
}

} // namespace

std::vector<Vertex> next_vertices(Shading& shading, std::span<const PathRay> paths,
                                  std::vector<Vec3d>& totals) {
  std::vector<WorldRay> rays;
  for (const PathRay& path : paths) rays.push_back(path.ray);
  std::vector<Hit> hits(rays.size());
  std::vector<int> objects(rays.size());
  std::vector<Vec3f> normals(rays.size());
  shading.objects.closest(rays, shading.intersector, hits, objects);
  shading.objects.normals(rays, hits, objects, shading.normals, normals);
  shading.secondary_rays += rays.size();

  const Vec3d sky = shading.scene.sky.radiance;
  std::vector<Vertex> vertices;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const PathRay& path = paths[i];
    std::optional<double> ground = shading.ground ? shading.ground->hit(rays[i]) : std::nullopt;
    if (ground && hits[i] && hits[i].t <= *ground) ground.reset();
    if (!hits[i] && !ground) {
      totals[path.root] += path.weight * sky;
      continue;
    }
    const double t = ground ? *ground : hits[i].t;
    Vertex& v = vertices.emplace_back();
    v.root = path.root;
    v.branch = path.branch;
    v.depth = path.depth;
    v.object = ground ? SceneRays::nothing : objects[i];
    v.inner = !ground && hits[i].from_inside;
    v.material = &material_of(shading, v.object);
    v.weight = path.weight;
    if (path.medium != SceneRays::nothing)
      v.weight *= transmittance(material_of(shading, path.medium).tint, t);
    v.point = rays[i].at(t);
    v.coverage = ground ? shading.ground->coverage(v.point) : 1;
    v.outside = ground ? v.point : rays[i].at(hits[i].t_outside);
    v.normal = ground ? shading.ground->up : Vec3d(normals[i]);
    if (v.inner) v.normal = -v.normal;
    v.back = -rays[i].direction;
    if (!ground) check_safe_point(shading.objects.object(v.object), v);
  }
  return vertices;
}

// As shade_tile, for a part of a tile whose vertices fit into a cache.
static void shade_part(Shading& shading, const Tile& tile, const GBuffer& gbuffer, int sample, float weight,
                       float* const rgba[4]) {
  const Sky& sky = shading.scene.sky;
  std::vector<std::size_t> pixels;
  std::vector<Vertex> vertices = first_vertices(shading, tile, gbuffer, sample, pixels);
  std::vector<Vec3d> totals(pixels.size(), Vec3d(0, 0, 0));
  std::vector<float> alphas;
  alphas.reserve(vertices.size());
  for (const Vertex& v : vertices) alphas.push_back(sky.visible ? 1 : static_cast<float>(v.coverage));

  for (bool first = true; !vertices.empty(); first = false) {
    const std::vector<Vec3d> radiance = local_radiance(shading, vertices);
    std::vector<PathRay> scattered, rays;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      const Vertex& v = vertices[i];
      Vec3d& total = totals[v.root];
      total += v.weight * (radiance[i] * v.coverage);
      if (v.coverage < 1 && (!first || sky.visible))
        total += v.weight * sky.radiance * (1 - v.coverage); // behind a ground that fades there is the sky
      if (v.material->kind != MaterialKind::mirror && v.material->kind != MaterialKind::glass) continue;
      scattered.clear();
      scatter(shading, v, scattered);
      for (const PathRay& ray : scattered) {
        if (ray.depth > shading.scene.max_depth ||
            !(std::max({ray.weight.x, ray.weight.y, ray.weight.z}) >= least_weight))
          total += ray.weight * sky.radiance;
        else
          rays.push_back(ray);
      }
    }
    vertices.clear();
    if (!rays.empty()) vertices = next_vertices(shading, rays, totals);
    for (Vertex& v : vertices) v.pixel = pixels[v.root];
  }

  for (std::size_t p = 0; p < pixels.size(); ++p) {
    for (int c = 0; c < 3; ++c) rgba[c][pixels[p]] += static_cast<float>(totals[p][c]) * weight;
    rgba[3][pixels[p]] += alphas[p] * weight;
  }
  if (!sky.visible) return;
  for (int y = tile.y_begin; y < tile.y_end; ++y)
    for (int x = tile.x_begin; x < tile.x_end; ++x) {
      const std::size_t i = gbuffer.index(x, y);
      if (gbuffer.status[i] != PixelStatus::miss) continue;
      for (int c = 0; c < 3; ++c) rgba[c][i] += static_cast<float>(sky.radiance[c]) * weight;
      rgba[3][i] += weight;
    }
}

void shade_tile(Shading& shading, const Tile& tile, const GBuffer& gbuffer, int sample, float weight,
                float* const rgba[4]) {
  constexpr int rows = 8;
  for (int y = tile.y_begin; y < tile.y_end; y += rows)
    shade_part(shading, {tile.x_begin, y, tile.x_end, std::min(y + rows, tile.y_end)}, gbuffer, sample,
               weight, rgba);
}

} // namespace levelray
