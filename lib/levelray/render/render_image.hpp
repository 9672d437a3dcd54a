// From a grid and a camera to an image.
#pragma once

#include "levelray/grid/block_grid.hpp"
#include "levelray/render/camera.hpp"
#include "levelray/render/image.hpp"
#include "levelray/render/lights.hpp"
#include "levelray/render/shade.hpp"

#include <functional>
#include <string>
#include <vector>

namespace levelray {

// What `t` and `Z` hold where there is nothing; every other AOV is 0 there, and A is 0.
inline constexpr float miss_depth = 1e30f;

// The AOVs by the option's words: Z, t, P, N, steps, tests.
const std::vector<std::string>& aov_names();

struct RenderOptions {
  CameraSettings camera;
  std::string intersector = "exact";    // intersect/intersectors.hpp
  std::string normals = "analytic";     // normal/normals.hpp
  std::vector<DirectionalLight> lights; // empty: three_point_lights
  std::string shading = "phong";
  bool shadows = false;
  bool ground = false; // a plane under the lowest point along camera.up
  int samples = 1;     // per pixel: a square number, on a regular grid; 1 is the pixel's centre
  std::vector<std::string> aovs;
  int repeat = 1;                            // render so often, and time each
  std::function<void(double done)> progress; // called from any thread, done in [0,1]; may be empty
};

struct RenderStats {
  std::uint64_t primary_rays = 0, shadow_rays = 0;    // of one repetition
  std::uint64_t hits = 0;                             // primary rays that met the level set
  std::vector<double> prepare_ms, trace_ms, shade_ms; // one of each per repetition
};

struct RenderedImage {
  Image image;
  RenderStats stats;
};

// Channels R, G, B, A, and those of the AOVs: Z, t, P.X, P.Y, P.Z, N.X, N.Y, N.Z, steps, tests.
//
// Z is the depth along the view axis and t the distance along the ray, P and N position and unit outward
// normal in world space, steps and tests the ray's counters (RayCounts). AOVs belong to the ray through the
// pixel's centre and are never filtered. With a ground plane they hold the ground where it is in front.
//
// `prepare` is the building of the level set, `trace` primary visibility with normals of the whole image (all
// samples), `shade` shadow rays and shading. The image is the same for any number of threads. Throws
// Error(usage) for illegal options.
RenderedImage render_image(const BlockGrid& grid, const RenderOptions& options);

// Throws Error(usage) for illegal options but camera, intersector and normals, which are checked where they
// are used.
void check_render_options(const RenderOptions& options);

// The memory that rendering takes besides grid and level set, in bytes.
std::uint64_t render_bytes(const RenderOptions& options);

} // namespace levelray
