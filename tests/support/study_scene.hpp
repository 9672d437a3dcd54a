// The scene of the measurements: a mesh centred on the origin with a longest side of 1, seen from direction
// (0.35, 0.30, 1) through 45 degrees.
#pragma once

#include "levelray/mesh/triangle_mesh.hpp"
#include "levelray/render/camera.hpp"

#include <algorithm>
#include <array>
#include <vector>

namespace levelray::test {

inline TriangleMesh centred_unit_mesh(TriangleMesh mesh) {
  const Box3d box = mesh.bounds();
  const Vec3d centre = (box.min + box.max) * 0.5, size = box.max - box.min;
  const double longest = std::max({size.x, size.y, size.z});
  for (Vec3d& v : mesh.vertices) v = (v - centre) / longest;
  return mesh;
}

// The eye's distance of 1.58 is where the longest side, face on, fills the view; 41 to 43 % of the rays hit
// the Stanford bunny.
inline Camera study_camera(int size) {
  CameraSettings settings;
  settings.width = settings.height = size;
  settings.target = Vec3d(0, 0, 0);
  settings.eye = Vec3d(0.35, 0.30, 1).normalized() * 1.58;
  return Camera(settings);
}

// The centre of each pixel of a square image. They follow each other in 32x32 tiles, and in them in squares
// of 4x4 pixels, so that runs of 1024 and of 16 are coherent; the last tiles of sizes that are no multiple of
// 32 are smaller.
inline std::vector<std::array<double, 2>> study_pixels(int size) {
  constexpr int tile = 32, square = 4;
  std::vector<std::array<double, 2>> pixels;
  pixels.reserve(static_cast<std::size_t>(size) * static_cast<std::size_t>(size));
  for (int ty = 0; ty < size; ty += tile)
    for (int tx = 0; tx < size; tx += tile)
      for (int qy = ty; qy < std::min(ty + tile, size); qy += square)
        for (int qx = tx; qx < std::min(tx + tile, size); qx += square)
          for (int y = qy; y < std::min(qy + square, size); ++y)
            for (int x = qx; x < std::min(qx + square, size); ++x) pixels.push_back({x + 0.5, y + 0.5});
  return pixels;
}

// The rays through them, unit directions.
inline std::vector<WorldRay> study_rays(int size) {
  const Camera camera = study_camera(size);
  std::vector<WorldRay> rays;
  for (const auto& [x, y] : study_pixels(size)) rays.push_back(camera.ray(x, y));
  return rays;
}

} // namespace levelray::test
