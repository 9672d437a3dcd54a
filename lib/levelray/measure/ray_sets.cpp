#include "levelray/measure/ray_sets.hpp"

#include <algorithm>
#include <cmath>
#include <random>

namespace levelray {

std::vector<std::array<double, 2>> tiled_pixels(int size) {
  constexpr int tile = 32, square = 4;
  std::vector<std::array<double, 2>> pixels;
  pixels.reserve(static_cast<std::size_t>(size) * static_cast<std::size_t>(size));
  for (int ty = 0; ty < size; ty += tile)
    for (int tx = 0; tx < size; tx += tile)
      for (int qy = ty; qy < std::min(ty + tile, size); qy += square)
        for (int qx = tx; qx < std::min(tx + tile, size); qx += square)
          for (int y = qy; y < std::min({qy + square, ty + tile, size}); ++y)
            for (int x = qx; x < std::min({qx + square, tx + tile, size}); ++x)
              pixels.push_back({x + 0.5, y + 0.5});
  return pixels;
}

std::vector<WorldRay> primary_rays(const Camera& camera) {
  std::vector<WorldRay> rays;
  for (const auto& [x, y] : tiled_pixels(camera.settings().width)) rays.push_back(camera.ray(x, y));
  return rays;
}

std::vector<WorldRay> random_chords(const Box3d& box, std::size_t count, std::uint64_t seed) {
  std::mt19937_64 engine(seed);
  const auto unit = [&] { return static_cast<double>(engine() >> 11) * 0x1p-53; }; // [0,1)
  const auto on_sphere = [&] {
    const double z = 2 * unit() - 1, angle = 2 * 3.14159265358979323846 * unit();
    const double r = std::sqrt(std::max(0.0, 1 - z * z));
    return Vec3d(r * std::cos(angle), r * std::sin(angle), z);
  };
  const Vec3d centre = (box.min + box.max) * 0.5;
  const double radius = 1.1 * (box.max - centre).length();
  std::vector<WorldRay> rays;
  while (rays.size() < count) {
    const Vec3d from = on_sphere(), to = on_sphere();
    const Vec3d along = to - from;
    const double length = std::sqrt(along.dot(along));
    if (!(length > 1e-6)) continue;
    WorldRay ray;
    ray.origin = centre + from * radius;
    ray.direction = along / length;
    rays.push_back(ray);
  }
  return rays;
}

} // namespace levelray
