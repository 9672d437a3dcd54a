// From a scene and a camera to an image.
#pragma once

#include "levelray/render/acceleration.hpp"
#include "levelray/render/camera.hpp"
#include "levelray/render/image.hpp"
#include "levelray/render/scene.hpp"
#include "levelray/render/shade.hpp"

#include <functional>
#include <string>
#include <vector>

namespace levelray {

// What `t` and `Z` hold where there is nothing; every other AOV is 0 there, and A is 0.
inline constexpr float miss_depth = 1e30f;

// The AOVs by the option's words: Z, t, P, N, id, steps, tests, interpolations, samples, shadow_steps,
// shadow_tests.
const std::vector<std::string>& aov_names();

struct RenderOptions {
  CameraSettings camera;
  std::string intersector = "exact"; // intersect/intersectors.hpp
  std::string normals = "analytic";  // normal/normals.hpp
  Acceleration acceleration;
  bool shadows = false;
  int samples = 1;        // per pixel: a square number, on a regular grid; 1 is the pixel's centre
  std::uint32_t seed = 0; // of the random directions of ambient occlusion
  std::vector<std::string> aovs;
  int repeat = 1;                            // render so often, and time each
  std::function<void(double done)> progress; // called from any thread, done in [0,1]; may be empty

  // For pictures of one grid only; scenes have their own.
  std::vector<DirectionalLight> lights; // empty: three_point_lights
  std::string shading = "phong";
  bool ground = false; // a plane under the lowest point along camera.up
};

struct RenderStats {
  std::uint64_t primary_rays = 0, shadow_rays = 0; // of one repetition
  std::uint64_t secondary_rays = 0;                // reflected, refracted, of ambient occlusion
  std::uint64_t hits = 0;                          // primary rays that met an object
  CountSums primary, shadow; // counters of primary rays, normals included, and of rays towards lights
  std::vector<double> prepare_ms, trace_ms, shade_ms; // one of each per repetition
};

struct RenderedImage {
  Image image;
  RenderStats stats;
};

// Channels R, G, B, A, and those of the AOVs: Z, t, P.X, P.Y, P.Z, N.X, N.Y, N.Z, id, and the
// counters by their names.
//
// Z is the depth along the view axis and t the distance along the ray, P and N position and unit outward
// normal in world space, id the Instance's or the ground's; steps, tests, interpolations and samples are the
// ray's counters (RayCounts), its normal's included. They belong to the ray through the pixel's centre and
// are never filtered. shadow_steps and shadow_tests are the sums over all rays from the pixel's paths towards
// lights, per sample. With a ground plane they hold the
// ground where it is in front. What mirrors and glass show does not appear in them.
//
// Light: every light's, where the surface faces it and, with options.shadows, no object that casts shadows
// lies between (glass and mirrors do too, as if opaque: there are no caustics; the ground casts none); the
// sky's and the ambient, less the ambient occlusion. Mirrors and glass are followed to scene.max_depth; glass
// reflects and refracts both, by Fresnel's equations (render/dielectric.hpp).
//
// `prepare` is the building of the level sets, `trace` min/max buffers and primary visibility with normals of
// the whole image (all samples), `shade` everything after. The image is the same for any number of threads.
// Throws Error(usage) for illegal options and scenes.
RenderedImage render_image(const Scene& scene, const RenderOptions& options);

// One grid, lit and shaded as the options say: render_image of one_grid_scene.
RenderedImage render_image(const BlockGrid& grid, const RenderOptions& options);
Scene one_grid_scene(const BlockGrid& grid, const RenderOptions& options);

// Throws Error(usage) for illegal options but camera, intersector and normals, which are checked where they
// are used.
void check_render_options(const RenderOptions& options);

// The memory that rendering takes besides grid and level set, in bytes.
std::uint64_t render_bytes(const RenderOptions& options);

} // namespace levelray
