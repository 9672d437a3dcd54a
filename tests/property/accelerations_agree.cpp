// No way of sparing rays work changes what they find: not a bit of hits, G-buffers or pictures.
#include "levelray/convert/mesh_to_grid.hpp"
#include "levelray/core/error.hpp"
#include "levelray/io/mesh_reader.hpp"
#include "levelray/mesh/prepare.hpp"
#include "levelray/render/render_image.hpp"
#include "levelray/trace/level_set.hpp"
#include "support/catch.hpp"
#include "support/random_cameras.hpp"

#include <filesystem>

using namespace levelray;
using namespace levelray::test;

namespace {

Acceleration acceleration(Traversal traversal, int minmax, ShadowScheme shadow, int steps = 12) {
  Acceleration a;
  a.traversal = traversal, a.minmax = minmax, a.shadow = shadow, a.occluder_steps = steps;
  return a;
}

// The first is the plain one that the others are compared with.
std::vector<Acceleration> accelerations() {
  using enum ShadowScheme;
  return {acceleration(Traversal::leaps, 0, ShadowScheme::plain),
          acceleration(Traversal::plain, 0, ShadowScheme::plain),
          acceleration(Traversal::leaps, 64, boxes),
          acceleration(Traversal::leaps, 3, occluder, 4),
          acceleration(Traversal::plain, 256, occluder),
          acceleration(Traversal::plain, 16, occluder, 32),
          acceleration(Traversal::plain, 128, boxes)};
}

bool same(const Hit& a, const Hit& b) {
  return a.status == b.status && a.from_inside == b.from_inside && a.t == b.t && a.t_outside == b.t_outside &&
         a.cell == b.cell && a.counts.tests == b.counts.tests;
}

// The names of channels that differ.
std::string differing(const Image& a, const Image& b) {
  std::string names;
  if (a.channels.size() != b.channels.size()) return "the number of channels";
  for (std::size_t c = 0; c < a.channels.size(); ++c)
    if (!std::equal(a.channels[c].values.begin(), a.channels[c].values.end(), b.channels[c].values.begin()))
      names += a.channels[c].name + " ";
  return names;
}

struct Sums {
  std::uint64_t hits = 0, shadow_rays = 0, spared_steps = 0, spared_tests = 0;
};

// Renders by all accelerations and compares.
void check_pictures(const Scene& scene, RenderOptions options, Sums& sums) {
  std::optional<RenderedImage> first;
  for (const Acceleration& a : accelerations()) {
    options.acceleration = a;
    RenderedImage rendered = render_image(scene, options);
    CAPTURE(int(a.traversal), a.minmax, int(a.shadow), a.occluder_steps);
    if (!first) {
      first = std::move(rendered);
      sums.hits += first->stats.hits, sums.shadow_rays += first->stats.shadow_rays;
      continue;
    }
    REQUIRE(differing(first->image, rendered.image) == "");
    REQUIRE(rendered.stats.hits == first->stats.hits);
    REQUIRE(rendered.stats.primary.tests == first->stats.primary.tests);
    REQUIRE(rendered.stats.shadow.tests <= first->stats.shadow.tests);
    sums.spared_tests += first->stats.shadow.tests - rendered.stats.shadow.tests;
    if (a.traversal == Traversal::leaps) {
      REQUIRE(rendered.stats.primary.steps <= first->stats.primary.steps);
      sums.spared_steps += first->stats.primary.steps - rendered.stats.primary.steps;
    }
  }
}

Scene lit_scene(std::span<const BlockGrid* const> grids, const Box3d& box) {
  Scene scene;
  for (const BlockGrid* grid : grids) scene.instances.emplace_back().grid = grid;
  scene.directional_lights.resize(3);
  scene.directional_lights[0].to_light = Vec3d(0.3, 0.8, 0.5).normalized();
  scene.directional_lights[1].to_light = Vec3d(-0.9, 0.1, -0.4).normalized();
  scene.directional_lights[2].to_light = Vec3d(0, 0, 1);
  // One light outside the object, and one that is likely to be inside.
  scene.point_lights.resize(2);
  scene.point_lights[0].position = box.max + (box.max - box.min) * 0.2;
  scene.point_lights[1].position = (box.min + box.max) * 0.5;
  for (PointLight& light : scene.point_lights) light.intensity = 100;
  scene.ground.emplace();
  scene.ambient = 0.1;
  return scene;
}

} // namespace

TEST_CASE("200 random cameras find the same hits by stepping and leaping, with min/max buffers and without") {
  const std::vector<Shape> shapes{
      {"torus", torus_grid(18, 7)}, {"plate", slab_grid(1.2, 22)}, {"gyroid", gyroid_grid(20)}};
  RandomRays random(17);
  std::size_t hits = 0, from_inside = 0, spared = 0;
  for (int i = 0; i < 200; ++i) {
    const Shape& shape = shapes[static_cast<std::size_t>(i) % shapes.size()];
    const LevelSet level_set(shape.grid);
    const int width = 64, height = 48;
    const Camera camera(random_camera(random, active_box(shape.grid), i, width, height));
    CAPTURE(i, shape.name, camera.settings().eye, camera.settings().target, camera.settings().fov_degrees);
    PinholeView view{camera.settings().eye, camera.right(), camera.up(), camera.forward()};
    view.half_height = camera.half_height();
    view.half_width = view.half_height * width / height;
    std::vector<WorldRay> rays;
    std::vector<std::pair<double, double>> positions; // anywhere in the pixels, their corners included
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const int kind = (x + y) % 3;
        positions.emplace_back(x + (kind == 0   ? 0.5
                                    : kind == 1 ? 0
                                                : random.uniform(0, 1)),
                               y + (kind == 0   ? 0.5
                                    : kind == 1 ? 0
                                                : random.uniform(0, 1)));
        rays.push_back(camera.ray(positions.back().first, positions.back().second));
      }
    for (const char* intersector : {"exact", "midpoint"}) {
      std::vector<Hit> plain(rays.size()), found(rays.size());
      closest_hits(level_set, rays, intersector, plain);
      for (const int resolution : {0, 1, 5, 48, 200})
        for (const Traversal traversal : {Traversal::leaps, Traversal::plain}) {
          std::vector<RayBounds> bounds;
          if (resolution > 0) {
            const MinMaxBuffer buffer(level_set.surface(), shape.grid.transform, view, resolution);
            for (const auto& [x, y] : positions) bounds.push_back(buffer.at(x / width, y / height));
          }
          PrimaryOptions options;
          options.intersector = intersector;
          options.traversal = traversal, options.bounds = bounds;
          closest_hits(level_set, rays, options, found);
          CAPTURE(intersector, resolution, int(traversal));
          std::size_t different = 0;
          for (std::size_t r = 0; r < rays.size(); ++r) {
            different += !same(found[r], plain[r]);
            if (traversal == Traversal::leaps) spared += plain[r].counts.steps - found[r].counts.steps;
          }
          REQUIRE(different == 0);
        }
      for (const Hit& hit : plain) hits += bool(hit), from_inside += hit.from_inside;
    }
  }
  CHECK(hits > 150000);
  CHECK(from_inside > 10000);
  CHECK(spared > 100000);
}

TEST_CASE("pictures of 200 random cameras are the same by all accelerations, of one object and of several") {
  const BlockGrid torus = torus_grid(14, 6), gyroid = gyroid_grid(15), plate = slab_grid(1.1, 15);
  const BlockGrid* const shapes[] = {&torus, &gyroid, &plate};
  RandomRays random(29);
  Sums sums;
  for (int i = 0; i < 200; ++i) {
    CAPTURE(i);
    const BlockGrid* grids[2] = {shapes[i % 3], shapes[(i + 1) % 3]};
    const bool several = i % 4 == 3;
    const Box3d box = active_box(*grids[0]);
    Scene scene = lit_scene({grids, several ? 2u : 1u}, box);
    if (several) {
      Instance again = scene.instances[0];
      again.world_from_object = Similarity::translated(Vec3d(9, -7, 12)) *
                                Similarity::rotated(random.direction(), random.uniform(-180, 180)) *
                                Similarity::scaled(random.uniform(0.1, 3));
      scene.instances.push_back(again);
    }
    RenderOptions options;
    options.camera = random_camera(random, box, i, 40, 32);
    options.shadows = true;
    options.samples = i % 10 == 0 ? 4 : 1;
    options.aovs = {"Z", "t", "P", "N", "tests", "interpolations", "samples"};
    check_pictures(scene, options, sums);
  }
  CHECK(sums.hits > 40000);
  CHECK(sums.shadow_rays > 40000);
  CHECK(sums.spared_steps > 10000);
  CHECK(sums.spared_tests > 10000);
}

TEST_CASE("all closed real meshes look the same by all accelerations") {
  const std::filesystem::path testdata = LEVELRAY_TESTDATA;
  if (!std::filesystem::exists(testdata / "classic")) {
    WARN("no real meshes in " << testdata << ": set LEVELRAY_TESTDATA to a folder of them");
    return;
  }
  std::vector<std::filesystem::path> files;
  for (const char* folder : {"classic", "hard"})
    for (const auto& entry : std::filesystem::directory_iterator(testdata / folder))
      if (entry.is_regular_file()) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  RandomRays random(43);
  Sums sums;
  int rendered = 0;
  for (const std::filesystem::path& file : files) {
    CAPTURE(file.string());
    TriangleMesh mesh;
    try {
      mesh = read_mesh(file.string()).mesh;
    } catch (const Error&) {
      continue; // some are meant to be refused; tests/unit/mesh_reader_testdata.cpp says which
    }
    const PreparedMesh prepared = prepare_mesh(std::move(mesh));
    if (!prepared.report.closed) continue;
    ConvertOptions convert;
    convert.resolution = 48;
    const BlockGrid grid = mesh_to_grid(prepared, convert).grid;
    const BlockGrid* const grids[] = {&grid};
    const Box3d box = active_box(grid);
    if (box.isEmpty()) continue;
    const Scene scene = lit_scene(grids, box);
    RenderOptions options;
    options.shadows = true;
    options.aovs = {"t", "N"};
    for (const int kind : {0, 1, 5}) {
      options.camera = random_camera(random, box, kind, 72, 64);
      check_pictures(scene, options, sums);
    }
    ++rendered;
  }
  CHECK(rendered >= 20);
  CHECK(sums.hits > 10000);
  CHECK(sums.spared_tests > 1000);
}
