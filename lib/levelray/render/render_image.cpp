#include "levelray/render/render_image.hpp"

#include "levelray/core/error.hpp"
#include "levelray/core/parallel.hpp"
#include "levelray/render/shading.hpp"
#include "levelray/render/visibility.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <memory>
#include <optional>
#include <span>

namespace levelray {

namespace {

double milliseconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

// Samples along a pixel's side; Error(usage) when `samples` is no square.
int samples_per_side(int samples) {
  const int side = static_cast<int>(std::lround(std::sqrt(static_cast<double>(samples))));
  if (samples < 1 || samples > 1024 || side * side != samples)
    throw Error(ErrorKind::usage, "--samples must be a square number: 1, 4, 9, 16, 25, ... 1024");
  return side;
}

} // namespace

void check_render_options(const RenderOptions& options) {
  samples_per_side(options.samples);
  if (options.acceleration.minmax < 0 || options.acceleration.minmax > 4096)
    throw Error(ErrorKind::usage, "--minmax must be within 1 and 4096");
  if (options.acceleration.occluder_steps < 0 || options.acceleration.occluder_steps > 1000000)
    throw Error(ErrorKind::usage, "--occluder-steps must be within 0 and 1000000");
  if (options.repeat < 1) throw Error(ErrorKind::usage, "--repeat must be at least 1");
  for (const std::string& aov : options.aovs) {
    bool known = false;
    for (const std::string& name : aov_names()) known = known || name == aov;
    if (!known)
      throw Error(ErrorKind::usage,
                  "unknown AOV \"" + aov +
                      "\"; choose from Z, t, P, N, id, steps, tests, interpolations, samples, shadow_steps, "
                      "shadow_tests");
  }
  for (const DirectionalLight& light : options.lights)
    if (!(std::abs(light.to_light.length() - 1) < 1e-9) || !(light.intensity >= 0))
      throw Error(ErrorKind::usage, "a light needs a unit direction and an intensity >= 0");
  shading_material(options.shading);
}

namespace {

// Copies the values of an AOV out of the G-buffer.
void fill_aov(const std::string& name, const GBuffer& gbuffer, const Camera& camera, const Scene& scene,
              std::span<const RayCounts> shadow_counts, int samples, Image& image) {
  const auto fill = [&](const std::string& channel, float miss, auto&& value) {
    std::vector<float>& values = image.add(channel);
    for (std::size_t i = 0; i < values.size(); ++i)
      values[i] = gbuffer.status[i] == PixelStatus::miss ? miss : static_cast<float>(value(i));
  };
  const Vec3d eye = camera.settings().eye;
  if (name == "Z")
    fill("Z", miss_depth, [&](std::size_t i) { return (gbuffer.point[i] - eye).dot(camera.forward()); });
  if (name == "t") fill("t", miss_depth, [&](std::size_t i) { return gbuffer.t[i]; });
  for (int c = 0; c < 3; ++c) {
    const std::string suffix = std::string(".") + "XYZ"[c];
    if (name == "P") fill("P" + suffix, 0, [&](std::size_t i) { return gbuffer.point[i][c]; });
    if (name == "N") fill("N" + suffix, 0, [&](std::size_t i) { return gbuffer.normal[i][c]; });
  }
  if (name == "id")
    fill("id", 0, [&](std::size_t i) {
      const std::int32_t object = gbuffer.object[i];
      return object == SceneRays::nothing ? scene.ground->id
                                          : scene.instances[static_cast<std::size_t>(object)].id;
    });
  // Counters are of the ray, whether it hit or not.
  const auto count = [&](std::span<const RayCounts> counts, auto member, float scale) {
    std::vector<float>& values = image.add(name);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(counts[i].*member) * scale;
  };
  if (name == "steps") count(gbuffer.counts, &RayCounts::steps, 1);
  if (name == "tests") count(gbuffer.counts, &RayCounts::tests, 1);
  if (name == "interpolations") count(gbuffer.counts, &RayCounts::interpolations, 1);
  if (name == "samples") count(gbuffer.counts, &RayCounts::samples, 1);
  const float per_sample = 1.0f / static_cast<float>(samples);
  if (name == "shadow_steps") count(shadow_counts, &RayCounts::steps, per_sample);
  if (name == "shadow_tests") count(shadow_counts, &RayCounts::tests, per_sample);
}

} // namespace

const std::vector<std::string>& aov_names() {
  static const std::vector<std::string> names{
      "Z",           "t", "P", "N", "id", "steps", "tests", "interpolations", "samples", "shadow_steps",
      "shadow_tests"};
  return names;
}

std::uint64_t render_bytes(const RenderOptions& options) {
  std::uint64_t channels = 4;
  for (const std::string& aov : options.aovs) channels += aov == "P" || aov == "N" ? 3 : 1;
  const std::uint64_t pixels = static_cast<std::uint64_t>(options.camera.width) * options.camera.height;
  const auto needs = [&](const char* aov) {
    return std::count(options.aovs.begin(), options.aovs.end(), aov) > 0;
  };
  const std::uint64_t shadow = needs("shadow_steps") || needs("shadow_tests") ? sizeof(RayCounts) : 0;
  // The image is held once more, in half or 8 bits with its compressed form, while it is encoded.
  return pixels * (GBuffer::bytes_per_pixel + shadow + channels * 2 * sizeof(float));
}

Scene one_grid_scene(const BlockGrid& grid, const RenderOptions& options) {
  Scene scene;
  Instance& instance = scene.instances.emplace_back();
  instance.grid = &grid;
  instance.material = shading_material(options.shading);
  scene.directional_lights =
      options.lights.empty() ? three_point_lights(Camera(options.camera)) : options.lights;
  scene.ambient = ambient_intensity;
  if (options.ground) scene.ground.emplace().up = options.camera.up;
  return scene;
}

RenderedImage render_image(const BlockGrid& grid, const RenderOptions& options) {
  check_render_options(options);
  return render_image(one_grid_scene(grid, options), options);
}

RenderedImage render_image(const Scene& scene, const RenderOptions& options) {
  check_render_options(options);
  check_scene(scene);
  const Camera camera(options.camera);
  const int width = options.camera.width, height = options.camera.height;
  const int side = samples_per_side(options.samples);
  const bool centre_is_a_sample = side % 2 == 1;
  const bool needs_centre_pass = !centre_is_a_sample && !options.aovs.empty();
  std::optional<Ground> ground;
  if (scene.ground) ground = place_ground(*scene.ground, scene.instances);

  RenderedImage result;
  RenderStats& stats = result.stats;
  GBuffer gbuffer;
  gbuffer.resize(width, height);
  const std::uint64_t pixels = static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
  stats.primary_rays = pixels * static_cast<std::uint64_t>(options.samples + (needs_centre_pass ? 1 : 0));

  std::atomic<std::uint64_t> done_pixels{0};
  const double all_pixels =
      static_cast<double>(pixels) * options.repeat * (2 * options.samples + needs_centre_pass);
  const auto advance = [&](const Tile& tile) {
    const auto n = static_cast<std::uint64_t>((tile.x_end - tile.x_begin) * (tile.y_end - tile.y_begin));
    const std::uint64_t done = done_pixels += n;
    if (options.progress) options.progress(static_cast<double>(done) / all_pixels);
  };

  for (int repetition = 0; repetition < options.repeat; ++repetition) {
    result.image = Image{width, height, {}};
    for (const char* name : {"R", "G", "B", "A"}) result.image.add(name);
    float* rgba[4];
    for (int c = 0; c < 4; ++c) rgba[c] = result.image.channels[static_cast<std::size_t>(c)].values.data();

    auto start = std::chrono::steady_clock::now();
    Acceleration acceleration = options.acceleration;
    if (!options.shadows && scene.ambient_occlusion.samples == 0) acceleration.shadow = ShadowScheme::plain;
    const SceneRays objects(scene.instances, acceleration);
    stats.prepare_ms.push_back(milliseconds_since(start));

    start = std::chrono::steady_clock::now();
    std::optional<PrimaryBounds> bounds;
    if (options.acceleration.minmax > 0) bounds.emplace(objects, camera, options.acceleration.minmax);
    double trace_ms = milliseconds_since(start), shade_ms = 0;

    const Visibility visible{objects,
                             camera,
                             ground ? &*ground : nullptr,
                             options.intersector,
                             options.normals,
                             bounds ? &*bounds : nullptr};
    Shading shading{scene,           objects,         visible.ground, options.intersector,
                    options.normals, options.shadows, options.seed,   options.camera.eye};
    std::vector<RayCounts> shadow_counts;
    for (const std::string& aov : options.aovs)
      if (aov == "shadow_steps" || aov == "shadow_tests") shadow_counts.resize(pixels);
    shading.shadow_counts_of = shadow_counts;
    SharedCounts primary;
    const auto trace = [&](double x, double y) {
      start = std::chrono::steady_clock::now();
      for_each_tile(width, height, [&](const Tile& tile) {
        primary += trace_tile(visible, tile, x, y, gbuffer);
        advance(tile);
      });
      trace_ms += milliseconds_since(start);
    };

    // Those of shadow rays are complete at the end only.
    const auto fill_aovs = [&](bool of_shadows) {
      for (const std::string& aov : options.aovs)
        if (aov.starts_with("shadow_") == of_shadows)
          fill_aov(aov, gbuffer, camera, scene, shadow_counts, options.samples, result.image);
    };

    for (int sample = 0; sample < options.samples; ++sample) {
      trace((sample % side + 0.5) / side, (sample / side + 0.5) / side);
      start = std::chrono::steady_clock::now();
      for_each_tile(width, height, [&](const Tile& tile) {
        shade_tile(shading, tile, gbuffer, sample, 1.0f / static_cast<float>(options.samples), rgba);
        advance(tile);
      });
      shade_ms += milliseconds_since(start);
      if (centre_is_a_sample && sample == options.samples / 2) // row and column side/2: the offset (0.5, 0.5)
        fill_aovs(false);
    }
    if (needs_centre_pass) {
      trace(0.5, 0.5);
      fill_aovs(false);
    }
    fill_aovs(true);
    stats.trace_ms.push_back(trace_ms);
    stats.shade_ms.push_back(shade_ms);
    stats.shadow_rays = shading.shadow_rays;
    stats.secondary_rays = shading.secondary_rays;
    stats.hits = shading.hits;
    stats.primary = primary.sums();
    stats.shadow = shading.shadow_counts.sums();
  }
  return result;
}

} // namespace levelray
