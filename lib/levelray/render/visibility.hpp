// Primary visibility: one ray per pixel into the G-buffer.
#pragma once

#include "levelray/render/camera.hpp"
#include "levelray/render/gbuffer.hpp"
#include "levelray/render/ground.hpp"
#include "levelray/render/primary_bounds.hpp"
#include "levelray/render/scene_rays.hpp"
#include "levelray/render/tiles.hpp"

#include <string_view>

namespace levelray {

// What is traced, and how.
struct Visibility {
  const SceneRays& objects;
  const Camera& camera;
  const Ground* ground;                  // or null
  std::string_view intersector, normals; // names of intersect/intersectors.hpp and normal/normals.hpp
  const PrimaryBounds* bounds = nullptr; // where there is something along the camera's rays, or null
};

// Fills the tile's pixels for rays through (i + x, j + y), x and y in [0,1). Returns the sums of the
// counters, normals included.
CountSums trace_tile(const Visibility& visible, const Tile& tile, double x, double y, GBuffer& gbuffer);

} // namespace levelray
