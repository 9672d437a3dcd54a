// From what rays found to colours.
#pragma once

#include "levelray/render/gbuffer.hpp"
#include "levelray/render/ground.hpp"
#include "levelray/render/scene_rays.hpp"
#include "levelray/render/tiles.hpp"

#include <atomic>
#include <string_view>

namespace levelray {

// Counters to which all threads add.
struct SharedCounts {
  std::atomic<std::uint64_t> steps{0}, tests{0}, interpolations{0}, samples{0};

  SharedCounts& operator+=(const CountSums& sums) {
    steps += sums.steps, tests += sums.tests;
    interpolations += sums.interpolations, samples += sums.samples;
    return *this;
  }
  CountSums sums() const { return {steps, tests, interpolations, samples}; }
};

// Everything that shading needs, and the sums it leaves.
struct Shading {
  const Scene& scene;
  const SceneRays& objects;
  const Ground* ground; // or null
  std::string_view intersector, normals;
  bool shadows;
  std::uint32_t seed;
  Vec3d eye;
  std::atomic<std::uint64_t> shadow_rays{0};    // towards lights
  std::atomic<std::uint64_t> secondary_rays{0}; // reflected, refracted, and of ambient occlusion
  std::atomic<std::uint64_t> hits{0};           // primary rays that met an object
  SharedCounts shadow_counts{};                 // of the rays towards lights
  std::span<RayCounts> shadow_counts_of{};      // per pixel, likewise; empty where nobody asks
};

// A point where a path meets a surface.
struct Vertex {
  std::size_t root;      // which of the tile's pixels the path belongs to
  std::size_t pixel = 0; // its index in the image; set by shade_tile
  std::uint64_t branch;  // a number of the path's own, for random numbers
  int depth;             // reflections and refractions so far
  int object;            // SceneRays' index; `nothing`: the ground
  bool inner;            // met from inside
  const Material* material;
  double coverage; // of the ground; 1 for objects
  Vec3d weight;    // what of the radiance here arrives at the eye
  Vec3d point;     // world units
  Vec3d outside;   // the last point before it that is proven to lie on the path's side
  Vec3d normal;    // unit, towards the path's side
  Vec3d back;      // unit, along the path's last ray to where it came from
};

// A ray of a path, on its way from a vertex.
struct PathRay {
  WorldRay ray; // unit direction
  std::size_t root;
  std::uint64_t branch;
  int depth;
  int medium; // the glass object in which it travels, or SceneRays::nothing
  Vec3d weight;
};

// Adds the tile's colours to `rgba` (four channels of the image), weighted. `sample` is the number of the
// pixels' sample, for random numbers.
void shade_tile(Shading& shading, const Tile& tile, const GBuffer& gbuffer, int sample, float weight,
                float* const rgba[4]);

// The radiance of the surfaces themselves at some vertices, without what they reflect or refract as mirrors:
// light of all lights, where shadows do not fall, and of the sky, where nothing hides it.
std::vector<Vec3d> local_radiance(Shading& shading, std::span<const Vertex> vertices);

// The part of the hemisphere around each vertex's normal, weighted by the cosine, that is hidden by something
// within ambient_occlusion.radius; estimated by ambient_occlusion.samples rays, and by fewer where less of
// the vertex arrives at the eye.
std::vector<double> occlusion(Shading& shading, std::span<const Vertex> vertices);

// Traces rays to their next vertices, in their order. Those that meet nothing have none, and add their part
// of the sky to totals[root].
std::vector<Vertex> next_vertices(Shading& shading, std::span<const PathRay> paths,
                                  std::vector<Vec3d>& totals);

// Appends the rays that go on from a mirror or glass, at most two; none from other materials.
void scatter(const Shading& shading, const Vertex& vertex, std::vector<PathRay>& rays);

} // namespace levelray
