// What is rendered: objects, lights and surroundings. The camera is in RenderOptions.
#pragma once

#include "levelray/grid/block_grid.hpp"
#include "levelray/render/lights.hpp"
#include "levelray/render/material.hpp"
#include "levelray/render/similarity.hpp"

#include <limits>
#include <optional>
#include <vector>

namespace levelray {

class LevelSet;

inline constexpr std::uint32_t largest_id = (1u << 24) - 1; // exact as a float

// A grid somewhere in the world. Instances may share one grid, which is then made ready for rays only once.
//
// Objects may touch and overlap as long as they are opaque. A glass object must not overlap another glass
// object; opaque ones may lie in it. Bubbles belong to the grid of the glass around them.
struct Instance {
  const BlockGrid* grid = nullptr;     // not owned; must outlive the rendering
  const LevelSet* level_set = nullptr; // of *grid where one is ready; else rendering builds its own
  Similarity world_from_object;
  Material material;
  std::uint32_t id = 1;      // for the AOV `id`, up to largest_id; 0 is what rays find that meet nothing
  bool casts_shadows = true; // on the shadow and occlusion rays of all objects
};

// Light of the same radiance from everywhere, and the background of reflected and refracted rays. A diffuse
// white surface that sees nothing else has just that radiance.
struct Sky {
  Vec3d radiance{0, 0, 0}; // scene-linear, >= 0
  bool visible = false; // behind the objects in the picture: pixels have alpha 1 then. Else it is only seen
                        // in mirrors and through glass, and where there is nothing alpha is 0.
};

// A plane under the objects, seen from above, that fades out around them (render/ground.hpp).
struct GroundSettings {
  Vec3d up{0, 1, 0};            // of any length but 0
  std::optional<double> height; // along the unit `up`, world units; default: the objects' lowest point
  std::optional<Vec3d> centre;  // around which it fades; default: the middle of the objects' bounds
  std::optional<double> radius; // opaque within 2 radii, gone at 6; default: that of the objects' bounds
  Material material{.albedo = Vec3d(0.55)}; // diffuse, phong or mirror
  std::uint32_t id = 0;
};

// How much of the sky's and the ambient light the surroundings hide. `samples` rays per point that is seen
// directly, fewer in mirrors and through glass, distributed as the cosine; each looks for objects and ground
// within `radius`.
struct AmbientOcclusion {
  int samples = 0;                                         // 0: nothing is hidden; at most 65536
  double radius = std::numeric_limits<double>::infinity(); // world units, > 0
};

struct Scene {
  std::vector<Instance> instances;
  std::vector<DirectionalLight> directional_lights;
  std::vector<PointLight> point_lights;
  double ambient = 0; // like a white sky of that radiance that rays never see, >= 0
  Sky sky;
  std::optional<GroundSettings> ground;
  AmbientOcclusion ambient_occlusion;
  int max_depth = 8; // reflections and refractions along a path, 0 .. 64; beyond, a ray sees the sky
};

// Throws Error(usage) where a value is out of its range, naming the object, light or setting.
void check_scene(const Scene& scene);

} // namespace levelray
