#include "levelray/render/visibility.hpp"

#include "levelray/trace/hit_normals.hpp"

#include <array>
#include <cmath>

namespace levelray {

namespace {

// Puts the ground into a pixel where it is in front of what is there.
void add_ground(const Ground& ground, const WorldRay& ray, std::size_t pixel, GBuffer& gbuffer) {
  const std::optional<double> t = ground.hit(ray);
  if (!t || (gbuffer.status[pixel] != PixelStatus::miss && gbuffer.t[pixel] <= *t)) return;
  gbuffer.status[pixel] = PixelStatus::ground;
  gbuffer.t[pixel] = *t;
  gbuffer.point[pixel] = gbuffer.outside[pixel] = ray.at(*t);
  gbuffer.normal[pixel] = Vec3f(ground.up);
  gbuffer.object[pixel] = SceneRays::nothing;
}

} // namespace

CountSums trace_tile(const Visibility& visible, const Tile& tile, double x, double y, GBuffer& gbuffer) {
  constexpr std::size_t capacity = static_cast<std::size_t>(tile_size) * tile_size;
  std::array<WorldRay, capacity> ray_store;
  std::array<Hit, capacity> hit_store;
  std::array<Vec3f, capacity> normal_store;
  std::array<int, capacity> object_store;

  const int width = tile.x_end - tile.x_begin;
  const auto count = static_cast<std::size_t>(width * (tile.y_end - tile.y_begin));
  for (std::size_t i = 0; i < count; ++i)
    ray_store[i] = visible.camera.ray(tile.x_begin + static_cast<int>(i) % width + x,
                                      tile.y_begin + static_cast<int>(i) / width + y);
  const std::span<const WorldRay> rays(ray_store.data(), count);
  const std::span<Hit> hits(hit_store.data(), count);
  const std::span<Vec3f> normals(normal_store.data(), count);
  const std::span<int> objects(object_store.data(), count);
  std::vector<RayBounds> bounds;
  if (visible.bounds) {
    bounds.resize(count * visible.objects.size());
    for (std::size_t i = 0; i < count; ++i)
      visible.bounds->look_up(tile.x_begin + static_cast<int>(i) % width + x,
                              tile.y_begin + static_cast<int>(i) / width + y, i, count, bounds);
  }
  visible.objects.closest(rays, visible.intersector, hits, objects, bounds);
  visible.objects.normals(rays, hits, objects, visible.normals, normals);

  const RayCounts normal_counts = counts_of_normal(visible.normals);
  CountSums sums;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t pixel =
        gbuffer.index(tile.x_begin + static_cast<int>(i) % width, tile.y_begin + static_cast<int>(i) / width);
    const Hit& hit = hits[i];
    RayCounts counts = hit.counts;
    if (hit) counts += normal_counts;
    gbuffer.counts[pixel] = counts;
    sums += counts;
    gbuffer.object[pixel] = objects[i];
    gbuffer.status[pixel] = !hit              ? PixelStatus::miss
                            : hit.from_inside ? PixelStatus::inner
                                              : PixelStatus::surface;
    if (hit) {
      gbuffer.t[pixel] = hit.t;
      gbuffer.point[pixel] = rays[i].at(hit.t);
      gbuffer.outside[pixel] = rays[i].at(hit.t_outside);
      gbuffer.normal[pixel] = normals[i];
    }
    if (visible.ground) add_ground(*visible.ground, rays[i], pixel, gbuffer);
  }
  return sums;
}

} // namespace levelray
