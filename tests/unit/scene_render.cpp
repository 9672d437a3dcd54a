// Pictures of scenes whose radiance is known.
#include "levelray/render/render_image.hpp"

#include "levelray/core/error.hpp"
#include "levelray/core/parallel.hpp"
#include "levelray/render/scene_extent.hpp"
#include "levelray/render/scene_rays.hpp"
#include "support/catch.hpp"
#include "support/trace_fixtures.hpp"

#include <cmath>

using namespace levelray;
using namespace levelray::test;

namespace {

const Vec3d ball_centre(-2.3, 1.7, 0.4); // of sphere_grid

Material plain(MaterialKind kind, const Vec3d& albedo = Vec3d(1, 1, 1)) {
  Material m;
  m.kind = kind;
  m.albedo = albedo;
  return m;
}

// A ball of that radius and place, made of a shared grid of radius 12.
Instance ball(const BlockGrid& grid, const Vec3d& centre, double radius, const Material& material) {
  Instance instance;
  instance.grid = &grid;
  instance.world_from_object = Similarity::translated(centre) *
                               Similarity::rotated(Vec3d(1, 2, -1), 50 * radius) *
                               Similarity::scaled(radius / 12) * Similarity::translated(-ball_centre);
  instance.material = material;
  return instance;
}

// Looks from +z at the origin; at the distance of 10 the picture is 5 high.
RenderOptions looking(int width, int height) {
  RenderOptions options;
  options.camera.eye = Vec3d(0, 0, 10);
  options.camera.fov_degrees = 2 * std::atan(0.25) * 180 / M_PI;
  options.camera.width = width;
  options.camera.height = height;
  options.shadows = true;
  options.normals = "interpolation-of-differences";
  return options;
}

Vec3d rgb(const Image& image, std::size_t i) {
  return Vec3d((*image.find("R"))[i], (*image.find("G"))[i], (*image.find("B"))[i]);
}

const BlockGrid& ball_grid() {
  static const BlockGrid grid = sphere_grid(12);
  return grid;
}

} // namespace

TEST_CASE(
    "a furnace stays uniform: under a sky alone, mirrors, glass and white convex objects are invisible") {
  Scene scene;
  scene.instances.push_back(ball(ball_grid(), Vec3d(-1.2, 0, 0), 0.9, plain(MaterialKind::glass)));
  scene.instances.push_back(ball(ball_grid(), Vec3d(1.2, 0, -1), 0.9, plain(MaterialKind::mirror)));
  const BlockGrid torus = torus_grid(18, 5);
  Instance ring;
  ring.grid = &torus;
  ring.world_from_object = Similarity::translated(Vec3d(0, 0, -3)) * Similarity::scaled(0.1);
  ring.material = plain(MaterialKind::glass);
  scene.instances.push_back(ring);
  scene.sky.radiance = Vec3d(0.25, 0.5, 2);
  scene.sky.visible = true;
  const RenderedImage seen = render_image(scene, looking(60, 40));
  REQUIRE(seen.stats.hits > 400);
  for (std::size_t i = 0; i < seen.image.pixel_count(); ++i) {
    // Reflected and refracted weights add up to 1 but for rounding in double; pixels are floats.
    CHECK((rgb(seen.image, i) - scene.sky.radiance).length() < 1e-6);
    CHECK((*seen.image.find("A"))[i] == 1);
  }
  RenderOptions within = looking(30, 30); // the camera stands in the glass
  within.camera.eye = Vec3d(-1.2, 0.3, 0.1);
  within.camera.fov_degrees = 100;
  const RenderedImage from_glass = render_image(scene, within);
  REQUIRE(from_glass.stats.hits == 900);
  for (std::size_t i = 0; i < from_glass.image.pixel_count(); ++i)
    CHECK((rgb(from_glass.image, i) - scene.sky.radiance).length() < 1e-6);

  scene.sky.visible = false;
  const RenderedImage hidden = render_image(scene, looking(60, 40));
  for (std::size_t i = 0; i < seen.image.pixel_count(); ++i)
    CHECK((*hidden.image.find("A"))[i] == (rgb(hidden.image, i).length() > 0 ? 1 : 0));
}

TEST_CASE("a convex object hides nothing of the sky from itself, a wall beside a ball half of it") {
  Scene scene;
  scene.instances.push_back(ball(ball_grid(), Vec3d(0, 0, 0), 1, plain(MaterialKind::diffuse)));
  scene.sky.radiance = Vec3d(1, 1, 1);
  scene.ambient_occlusion.samples = 64;
  const RenderedImage image = render_image(scene, looking(40, 40));
  double least = 1;
  for (std::size_t i = 0; i < image.image.pixel_count(); ++i)
    if ((*image.image.find("A"))[i] > 0) least = std::min(least, rgb(image.image, i).x);
  // Within a cell the interpolated surface bulges by h^2/(4R), so next to a point it rises above the plane of
  // its smooth normal at slopes up to h/(2R) = 1/24; within that angle a of the horizon lies sin^2 a = 0.0017
  // of the hemisphere as the cosine weighs it: no more than one of 64 stratified rays.
  CHECK(least >= 1 - 1.0 / 64);

  // A ground touching the ball: at the ball's equator it fills the lower half of what is seen. Its coverage
  // is 1 within two radii of the ball and fades out to six, so rays down to 2 / (2 R) hit it fully.
  scene.ground.emplace().material = plain(MaterialKind::diffuse);
  scene.ambient_occlusion.samples = 4096;
  RenderOptions options = looking(1, 1);
  options.camera.fov_degrees = 0.01;
  const RenderedImage equator = render_image(scene, options);
  // Rays of elevation -e reach the plane one radius below at 1 / tan e radii: those steeper than 1/5 (from
  // the surface, itself one radius from the centre) find full coverage, and below 1/5 they fade: the hidden
  // part of 1/2 lacks less than what lies between elevations 0 and -atan(1): the cosine-weighted share of the
  // sine up to s is about (2/pi) s, of which coverage takes more than half.
  const double open = rgb(equator.image, 0).x;
  CHECK(open > 0.5);
  CHECK(open < 0.5 + 2 / M_PI * 0.5);
}

TEST_CASE("occlusion stops at its radius") {
  Scene scene;
  scene.instances.push_back(ball(ball_grid(), Vec3d(0, 0, 0), 1, plain(MaterialKind::diffuse)));
  // A second ball right in front of the first, behind the camera's back: hides the pole of the first.
  scene.instances.push_back(ball(ball_grid(), Vec3d(0, 0, 13), 2, plain(MaterialKind::diffuse)));
  scene.sky.radiance = Vec3d(1, 1, 1);
  scene.ambient_occlusion.samples = 4096;
  RenderOptions options = looking(1, 1);
  options.camera.fov_degrees = 0.01;
  // The form factor of a ball of radius 2 seen straight on from a distance of 12 is (2/12)^2. 4096 points of
  // Hammersley's, whose discrepancy is of order log(n)/n = 0.002, estimate the area of its disk; the ball's
  // radius is off by h^2/(4R), 1e-3 of it.
  const double part = 4.0 / 144;
  CHECK(rgb(render_image(scene, options).image, 0).x == Approx(1 - part).margin(0.003));
  scene.ambient_occlusion.radius = 9.9; // the nearest point is at 13 - 2 - 1 = 10
  CHECK(rgb(render_image(scene, options).image, 0).x == Approx(1).margin(0.0017)); // by itself, see above
  scene.ambient_occlusion.radius = 13;
  CHECK(rgb(render_image(scene, options).image, 0).x == Approx(1 - part).margin(0.003));
}

TEST_CASE("a point light obeys the inverse square law, and only what is nearer than it casts a shadow") {
  Scene scene;
  scene.instances.push_back(
      ball(ball_grid(), Vec3d(0, 0, 0), 1, plain(MaterialKind::diffuse, Vec3d(0.5, 1, 1))));
  PointLight& light = scene.point_lights.emplace_back();
  light.position = Vec3d(0, 0, 5);
  light.intensity = 8;
  light.color = Vec3d(1, 0.5, 0.25);
  RenderOptions options = looking(1, 1);
  options.camera.fov_degrees = 0.01;
  const auto radiance = [&] { return rgb(render_image(scene, options).image, 0); };
  // The pole is 4 from the light: 8/16, but for the shift of the interpolated surface by h^2/(4R) < 0.002.
  const Vec3d lit(0.25, 0.25, 0.125);
  CHECK((radiance() - lit).length() < 0.002);

  light.position = Vec3d(0, 0, 3); // at twice the nearness
  CHECK((radiance() - lit * 4.0).length() < 0.01);
  light.position = Vec3d(0, 0, -3); // behind the horizon
  CHECK(radiance() == Vec3d(0, 0, 0));

  light.position = Vec3d(0, 0, 5);
  scene.instances.push_back(ball(ball_grid(), Vec3d(0, 0, 6.5), 1, plain(MaterialKind::diffuse)));
  options.camera.eye = Vec3d(0.5, 0, 4.9); // between the light and the ball, beside the blocker's shadow
  options.camera.target = Vec3d(0, 0, 1);
  CHECK(radiance().x > 0.2);                                            // the blocker is behind the light
  scene.instances[1].world_from_object.translation -= Vec3d(0, 0, 3.5); // now it hides it
  options.camera.eye = Vec3d(3, 0, 1.5);
  CHECK(radiance() == Vec3d(0, 0, 0));
  scene.instances[1].casts_shadows = false;
  CHECK(radiance().x > 0.2);
  scene.instances[1].casts_shadows = true;
  light.casts_shadows = false;
  CHECK(radiance().x > 0.2);
}

TEST_CASE("instances share a level set, meet rays where the closed form says, and carry their ids") {
  Scene scene;
  const Vec3d centres[3] = {Vec3d(-1.5, 0.5, 0), Vec3d(0.2, -0.5, -2), Vec3d(1.6, 0.4, 1)};
  const double radii[3] = {0.8, 1.3, 0.5};
  for (int i = 0; i < 3; ++i) {
    scene.instances.push_back(ball(ball_grid(), centres[i], radii[i], plain(MaterialKind::diffuse)));
    scene.instances.back().id = static_cast<std::uint32_t>(100 + i);
  }
  scene.instances[2].id = largest_id;
  const SceneRays objects(scene.instances);
  CHECK(objects.object(0).level_set == objects.object(1).level_set);
  CHECK(objects.object(0).level_set == objects.object(2).level_set);
  CHECK_FALSE(scene_bounds(scene.instances).isEmpty());
  // The bounds are of crossings on edges; those of a ball of 12 voxels reach to within 1/(8 * 12) voxel of
  // its poles' tangents.
  CHECK((scene_bounds(scene.instances).min - Vec3d(-2.3, -1.8, -3.3)).length() < 0.02);

  RenderOptions options = looking(120, 90);
  options.aovs = {"t", "N", "id", "P"};
  const Image image = render_image(scene, options).image;
  const Camera camera(options.camera);
  int met[3] = {0, 0, 0};
  for (int y = 0; y < 90; ++y)
    for (int x = 0; x < 120; ++x) {
      const auto i = static_cast<std::size_t>(y * 120 + x);
      const WorldRay ray = camera.ray(x + 0.5, y + 0.5);
      double nearest = 1e30;
      int which = -1;
      bool clear = true; // of silhouettes, where a shift of the surface decides
      for (int b = 0; b < 3; ++b) {
        const Vec3d q = ray.origin - centres[b];
        const double along = -q.dot(ray.direction), off = std::sqrt(q.dot(q) - along * along) / radii[b];
        if (off > 0.95 && off < 1.05) clear = false;
        if (off < 1 && along - radii[b] * std::sqrt(1 - off * off) < nearest)
          nearest = along - radii[b] * std::sqrt(1 - off * off), which = b;
      }
      if (!clear) continue;
      const float id = (*image.find("id"))[i];
      if (which < 0) {
        CHECK(id == 0);
        CHECK((*image.find("A"))[i] == 0);
        continue;
      }
      ++met[which];
      CHECK(id == static_cast<float>(scene.instances[static_cast<std::size_t>(which)].id));
      // The surface is h^2/(4R) = 1/48 voxel of radius/12 off at most, by cos i >= 0.31 along the ray.
      CHECK(std::fabs((*image.find("t"))[i] - nearest) < radii[which] / 12 / 48 / 0.31);
      const Vec3d n((*image.find("N.X"))[i], (*image.find("N.Y"))[i], (*image.find("N.Z"))[i]);
      const Vec3d expected = (ray.at(nearest) - centres[which]).normalized();
      CHECK((n - expected).length() < 1.8 / 144); // as in property/glass_paths.cpp, with tan i up to 3.0
    }
  CHECK((met[0] > 100 && met[1] > 100 && met[2] > 40));
}

TEST_CASE("one instance in its place is the same picture as its grid, and threads change no byte") {
  RenderOptions options = looking(70, 50);
  options.aovs = aov_names();
  options.ground = true;
  options.samples = 4;
  const BlockGrid grid = torus_grid(1.5, 0.5);
  const Scene scene = one_grid_scene(grid, options);
  const RenderedImage a = render_image(grid, options), b = render_image(scene, options);
  for (const Image::Channel& channel : a.image.channels) CHECK(*b.image.find(channel.name) == channel.values);

  Scene rich;
  rich.instances.push_back(ball(ball_grid(), Vec3d(-1, 0, 0), 1, plain(MaterialKind::glass)));
  rich.instances.push_back(ball(ball_grid(), Vec3d(1, 0, 0), 0.7, plain(MaterialKind::mirror)));
  rich.instances.push_back(ball(ball_grid(), Vec3d(0, 1, -2), 1, plain(MaterialKind::phong)));
  rich.sky.radiance = Vec3d(0.5, 0.6, 0.7);
  rich.ambient_occlusion.samples = 5;
  rich.point_lights.emplace_back().position = Vec3d(2, 3, 4);
  rich.ground.emplace();
  std::vector<Image> images;
  for (const int threads : {1, 2, 7}) {
    const ThreadLimit limit(threads);
    images.push_back(render_image(rich, options).image);
  }
  for (std::size_t i = 1; i < images.size(); ++i)
    for (const Image::Channel& channel : images[0].channels)
      CHECK(*images[i].find(channel.name) == channel.values);
  options.seed = 1;
  CHECK(*render_image(rich, options).image.find("R") != *images[0].find("R"));
}

TEST_CASE("a grey mirror and tinted glass take their part, and depth 0 sees only the sky in them") {
  Scene scene;
  scene.instances.push_back(ball(ball_grid(), Vec3d(0, 0, 0), 1, plain(MaterialKind::mirror)));
  scene.instances[0].material.tint = Vec3d(0.25, 0.5, 1);
  scene.sky.radiance = Vec3d(1, 1, 1);
  RenderOptions options = looking(1, 1);
  options.camera.fov_degrees = 0.01;
  const auto radiance = [&] { return rgb(render_image(scene, options).image, 0); };
  CHECK((radiance() - Vec3d(0.25, 0.5, 1)).length() < 1e-6);

  // Straight through a ball of radius 1 and index 1.5: R = 0.04 at each crossing, T = tint^2 between them.
  // All orders of inner reflections: R + (1-R)^2 T (1 + R T + ...) = R + (1-R)^2 T / (1 - R T). The ball's
  // diameter is off by less than 2 * h^2/(4R) = 0.0035; the deepest ray has passed it nine times. Rays of a
  // weight below 2^-12 see the sky, here brighter by less than that each.
  scene.instances[0].material = plain(MaterialKind::glass);
  scene.instances[0].material.tint = Vec3d(0.25, 0.5, 1);
  const Vec3d seen = radiance();
  for (int c = 0; c < 3; ++c) {
    const double t = std::pow(scene.instances[0].material.tint[c], 2), r = 0.04;
    CHECK(seen[c] ==
          Approx(r + (1 - r) * (1 - r) * t / (1 - r * t)).margin(0.0035 * 1.4 * 0.3 + 3 * 0x1p-12));
  }
  scene.max_depth = 0;
  CHECK((radiance() - Vec3d(1, 1, 1)).length() < 1e-6);
}

TEST_CASE("mirrors and glass scatter no light of lamps, but for a highlight where they are told to") {
  Scene scene;
  scene.instances.push_back(ball(ball_grid(), Vec3d(0, 0, 0), 1, plain(MaterialKind::mirror)));
  scene.directional_lights.emplace_back(); // from the camera
  RenderOptions options = looking(1, 1);
  options.camera.fov_degrees = 0.01;
  for (const MaterialKind kind : {MaterialKind::mirror, MaterialKind::glass}) {
    scene.instances[0].material = plain(kind);
    CHECK(rgb(render_image(scene, options).image, 0) == Vec3d(0, 0, 0));
    scene.instances[0].material.specular = 0.5;
    CHECK(rgb(render_image(scene, options).image, 0).x ==
          Approx(0.5).margin(0.01)); // (1 - 2 * 1.22^2/144^2)^32
  }
  scene.instances[0].material.kind = MaterialKind::phong;
  CHECK(rgb(render_image(scene, options).image, 0).x == Approx(1.5).margin(0.01));
  scene.instances[0].material.kind = MaterialKind::diffuse;
  CHECK(rgb(render_image(scene, options).image, 0).x == Approx(1).margin(0.01));
}

TEST_CASE("a mirror shows what stands in front of it, in its place") {
  // The camera looks along -z at a mirror ball; a red ball behind the camera's eye, on the axis, is
  // seen in the middle.
  Scene scene;
  scene.instances.push_back(ball(ball_grid(), Vec3d(0, 0, 0), 1, plain(MaterialKind::mirror)));
  scene.instances.push_back(
      ball(ball_grid(), Vec3d(0, 0, 20), 6, plain(MaterialKind::diffuse, Vec3d(1, 0, 0))));
  scene.ambient = 0.5;
  scene.sky.radiance = Vec3d(0, 0, 1);
  RenderOptions options = looking(161, 161);
  const Image image = render_image(scene, options).image;
  // Reflected at the point with the polar angle a, an axial ray leaves at 2 a + its own slope. It hits the
  // ball when its line passes within 6 of (0,0,20).
  const Camera camera(options.camera);
  int red = 0;
  for (int y = 0; y < 161; ++y)
    for (int x = 0; x < 161; ++x) {
      const WorldRay ray = camera.ray(x + 0.5, y + 0.5);
      const double b = ray.origin.dot(ray.direction), inside = b * b - (100 - 1);
      if (!(inside > 0.05)) continue;
      const Vec3d n = ray.at(-b - std::sqrt(inside)), d = ray.direction - n * (2 * ray.direction.dot(n));
      const Vec3d q = Vec3d(0, 0, 20) - n;
      const double along = q.dot(d), off = std::sqrt(q.dot(q) - along * along);
      // Directions are off by 2.5/144 (property/glass_paths.cpp) over a way of 20: 0.35.
      if (std::fabs(off - 6) < 0.35) continue;
      const Vec3d seen = rgb(image, static_cast<std::size_t>(y * 161 + x));
      const bool expected = along > 0 && off < 6;
      red += expected;
      CHECK((seen.x > 0.4) == expected);
      CHECK((seen.z > 0.9) == !expected);
    }
  CHECK(red > 20);
}

TEST_CASE("illegal scenes are refused with a reason") {
  const auto reason = [](auto change) -> std::string {
    Scene scene;
    scene.instances.push_back(ball(ball_grid(), Vec3d(0, 0, 0), 1, plain(MaterialKind::glass)));
    scene.point_lights.emplace_back();
    scene.directional_lights.emplace_back();
    scene.ground.emplace();
    change(scene);
    try {
      render_image(scene, looking(2, 2));
    } catch (const Error& error) {
      return error.kind() == ErrorKind::usage ? error.what() : "";
    }
    return "";
  };
  using Catch::Contains;
  CHECK_THAT(reason([](Scene& s) { s.instances[0].material.ior = 0; }), Contains("object 1: ior"));
  CHECK_THAT(reason([](Scene& s) { s.instances[0].material.tint.y = 1.5; }), Contains("object 1: tint"));
  CHECK_THAT(reason([](Scene& s) { s.instances[0].grid = nullptr; }), Contains("object 1"));
  CHECK_THAT(reason([](Scene& s) { s.instances[0].id = largest_id + 1; }), Contains("object 1: id"));
  CHECK_THAT(reason([](Scene& s) { s.instances[0].world_from_object.scale = 0; }), Contains("scale"));
  CHECK_THAT(reason([](Scene& s) { s.point_lights[0].position.x = NAN; }), Contains("point light 1"));
  CHECK_THAT(reason([](Scene& s) { s.directional_lights[0].intensity = -1; }), Contains("light 1"));
  CHECK_THAT(reason([](Scene& s) { s.sky.radiance.x = -1; }), Contains("sky"));
  CHECK_THAT(reason([](Scene& s) { s.ground->material.kind = MaterialKind::glass; }), Contains("ground"));
  CHECK_THAT(reason([](Scene& s) { s.ambient_occlusion.radius = 0; }), Contains("occlusion"));
  CHECK_THAT(reason([](Scene& s) { s.ambient_occlusion.samples = -1; }), Contains("occlusion"));
  CHECK_THAT(reason([](Scene& s) { s.max_depth = 65; }), Contains("max_depth"));
}
