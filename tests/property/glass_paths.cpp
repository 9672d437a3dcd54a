// Paths through glass and off mirrors: no crossing is lost or counted twice, and directions are those of the
// closed forms.
#include "levelray/render/dielectric.hpp"
#include "levelray/render/shading.hpp"
#include "levelray/trace/field_probe.hpp"
#include "support/catch.hpp"
#include "support/trace_fixtures.hpp"

#include <array>
#include <cmath>
#include <stdexcept>

using namespace levelray;
using namespace levelray::test;

namespace {

Material glass(double ior) {
  Material m;
  m.kind = MaterialKind::glass;
  m.ior = ior;
  return m;
}

Instance placed(const BlockGrid& grid, const Similarity& place, const Material& material) {
  Instance instance;
  instance.grid = &grid;
  instance.world_from_object = place;
  instance.material = material;
  return instance;
}

// The machinery of a scene without a picture.
struct Lab {
  explicit Lab(Scene s, std::string_view normals = "interpolation-of-differences")
      : scene(std::move(s)), objects(scene.instances), shading{scene,   objects, nullptr, "exact",
                                                               normals, false,   0,       Vec3d(0, 0, 0)} {}
  Scene scene;
  SceneRays objects;
  Shading shading;
};

std::vector<PathRay> starting_paths(const std::vector<WorldRay>& rays) {
  std::vector<PathRay> paths;
  for (const WorldRay& ray : rays)
    paths.push_back({ray, paths.size(), paths.size(), 0, SceneRays::nothing, Vec3d(1, 1, 1)});
  return paths;
}

struct Crossings {
  std::uint64_t vertices = 0, refracted = 0, reflected = 0;
  std::uint64_t lost = 0;   // rays in glass that meet nothing
  std::uint64_t wrong = 0;  // rays that meet a surface from the side on which they do not travel
  std::uint64_t sealed = 0; // neither total reflection nor a way through
};

// Follows paths that begin outside; at each crossing one of the rays goes on, the refracted one three times
// out of four.
Crossings follow(Lab& lab, std::vector<PathRay> paths, int depth) {
  Crossings sum;
  RandomRays random(5);
  std::vector<Vec3d> totals(paths.size());
  for (int step = 0; step < depth && !paths.empty(); ++step) {
    std::vector<int> medium(totals.size(), SceneRays::nothing), met(totals.size(), 0);
    for (const PathRay& path : paths) medium[path.root] = path.medium;
    const std::vector<Vertex> vertices = next_vertices(lab.shading, paths, totals);
    std::vector<PathRay> next, scattered;
    for (const Vertex& v : vertices) {
      met[v.root] = 1;
      ++sum.vertices;
      sum.wrong += v.inner != (medium[v.root] == v.object);
      scattered.clear();
      scatter(lab.shading, v, scattered);
      if (scattered.empty() || scattered.size() > 2) throw std::logic_error("glass scatters into one or two");
      const bool through = scattered.size() == 2 && random.uniform(0, 1) < 0.75;
      if (scattered.size() == 1) {
        // Total reflection is no surprise beyond the critical angle and at grazing incidence, by either of
        // the two normals that scattering may use.
        const SceneObject& object = lab.objects.object(v.object);
        const FieldProbe probe =
            probe_field(object.level_set->grid(), object.object_from_world.point(v.point));
        const Vec3d gradient = object.instance->world_from_object.rotate(probe.gradient).normalized();
        const auto may_reflect = [&](double cosine) {
          const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
          return !(cosine > 0.2) || !(sine * (v.inner ? v.material->ior : 1 / v.material->ior) < 0.9);
        };
        if (!may_reflect(v.back.dot(v.normal)) && !may_reflect(std::fabs(v.back.dot(gradient)))) ++sum.sealed;
      }
      ++(through ? sum.refracted : sum.reflected);
      next.push_back(scattered[through ? 1 : 0]);
    }
    for (const PathRay& path : paths)
      if (path.medium != SceneRays::nothing && !met[path.root]) ++sum.lost;
    paths = std::move(next);
  }
  return sum;
}

} // namespace

TEST_CASE("paths enter and leave glass in turns, on a million rays, however thin the glass") {
  const unsigned seed = 77;
  CAPTURE(seed);
  const std::array<Shape, 4> shapes{Shape{"sphere", sphere_grid(12)}, Shape{"torus", torus_grid(18, 1.5)},
                                    Shape{"slab", slab_grid(0.8)}, Shape{"gyroid", gyroid_grid()}};
  const Similarity turned = Similarity::rotated(Vec3d(1, 2, 3), 37) * Similarity::scaled(0.37);
  const std::array<Similarity, 3> places{Similarity{}, Similarity::translated(Vec3d(110, -70, 30)) * turned,
                                         Similarity::translated(Vec3d(5e6, -3e6, 1e6)) *
                                             turned}; // 2^24 voxels from the origin
  for (const Shape& shape : shapes)
    for (const std::string_view normals : {"analytic", "interpolation-of-differences"})
      for (const Similarity& place : places) {
        CAPTURE(shape.name, normals, place.translation);
        Scene scene;
        scene.instances.push_back(placed(shape.grid, place, glass(1.5)));
        Lab lab(std::move(scene), normals);
        const Box3d box = active_box(shape.grid);
        RandomRays random(seed);
        Crossings sum;
        for (int batch = 0; batch < 42; ++batch) {
          std::vector<WorldRay> rays;
          for (int i = 0; i < 1000; ++i) {
            rays.push_back(place.ray(random.through(box)));
            rays.back().direction.normalize();
          }
          const Crossings c = follow(lab, starting_paths(rays), 8);
          sum.vertices += c.vertices, sum.refracted += c.refracted, sum.reflected += c.reflected;
          sum.lost += c.lost, sum.wrong += c.wrong, sum.sealed += c.sealed;
        }
        CAPTURE(sum.vertices, sum.refracted, sum.reflected);
        CHECK(sum.refracted > 10000);
        CHECK(sum.lost == 0);
        CHECK(sum.wrong == 0);
        CHECK(sum.sealed == 0);
      }
}

namespace {

// Where a ray leaves a ball that it entered, and in which direction, by the closed forms.
struct BallExit {
  Vec3d inside, out; // unit directions in the ball and behind it
};

BallExit through_ball(const Vec3d& centre, double radius, const WorldRay& ray, double ior) {
  const auto crossing = [&](const Vec3d& origin, const Vec3d& d, double sign) {
    const Vec3d q = origin - centre;
    const double b = q.dot(d);
    return -b + sign * std::sqrt(b * b - (q.dot(q) - radius * radius));
  };
  const auto bent = [](const Vec3d& d, const Vec3d& n, double eta) {
    // Snell: the part along the surface is scaled by eta, the rest follows from the unit length.
    const Vec3d along = (d - n * d.dot(n)) * eta;
    return along - n * std::sqrt(1 - along.dot(along));
  };
  BallExit exit;
  const Vec3d entry = ray.at(crossing(ray.origin, ray.direction, -1));
  exit.inside = bent(ray.direction, (entry - centre) / radius, 1 / ior);
  const Vec3d leaving = entry + exit.inside * crossing(entry, exit.inside, 1);
  exit.out = bent(exit.inside, (centre - leaving) / radius, ior);
  return exit;
}

double angle(const Vec3d& a, const Vec3d& b) {
  return std::atan2(a.cross(b).length(), a.dot(b));
}

} // namespace

// A bound for |error of direction| R^2 / h^2, with the radius R and the voxel h, for rays that hit the ball
// at distances from its axis up to 0.9 R (cos i >= 0.43):
//  - a trilinear interpolant is off by h^2/8 times the sum of the second derivatives along the axes, 2/R for
//  a
//    sphere: h^2/(4R). That moves the hit by h^2/(4R cos i) along the ray and turns the ball's normal there
//    by tan i h^2/(4 R^2) <= 0.52 h^2/R^2;
//  - central differences are off by h^2/6 of the third derivatives, some 1/R^2, and interpolating them adds
//    h^2/8 of some 2/R^2 along each of two axes across the normal: together less than 0.7 h^2/R^2.
// So a normal is off by 1.22 h^2/R^2. A mirror doubles that: 2.5. Refraction turns by |1 - eta cos i/cos t| <
// 1 of it at the entry: 1.22. The exit turns by 1.5 cos t/cos i < 3.0 of the entry's error and by 2.0 of that
// of its own normal, which the shift of the entry (0.6) moves too: 3.0 * 1.22 + 2.0 * (1.22 + 0.6) = 7.3.
TEST_CASE("a glass ball and a mirror ball turn rays as the closed forms do, to second order in the voxel") {
  const unsigned seed = 31;
  CAPTURE(seed);
  double previous_glass = 0, previous_mirror = 0;
  for (const double radius : {8.0, 16.0, 32.0}) {
    const BlockGrid grid = sphere_grid(radius);
    const Vec3d centre(-2.3, 1.7, 0.4);
    const Similarity place = Similarity::translated(Vec3d(3, 4, -5)) *
                             Similarity::rotated(Vec3d(-1, 0.2, 0.7), 71) * Similarity::scaled(1 / radius);
    Material mirror;
    mirror.kind = MaterialKind::mirror;
    double worst_inside = 0, worst_out = 0, worst_mirror = 0;
    for (const bool is_mirror : {false, true}) {
      Scene scene;
      scene.instances.push_back(placed(grid, place, is_mirror ? mirror : glass(1.5)));
      Lab lab(std::move(scene));
      RandomRays random(seed);
      std::vector<WorldRay> rays;
      for (int i = 0; i < 20000; ++i) {
        // Towards a point of a disk of 0.9 R across the ray.
        WorldRay ray;
        ray.direction = random.direction();
        const Vec3d u = ray.direction.cross(random.direction()).normalized();
        const double off = 0.9 * std::sqrt(random.uniform(0, 1));
        ray.origin = place.point(centre) + u * off - ray.direction * random.uniform(2, 20);
        rays.push_back(ray);
      }
      std::vector<Vec3d> totals(rays.size());
      const std::vector<Vertex> first = next_vertices(lab.shading, starting_paths(rays), totals);
      REQUIRE(first.size() == rays.size());
      std::vector<PathRay> scattered, through;
      for (const Vertex& v : first) {
        scattered.clear();
        scatter(lab.shading, v, scattered);
        const WorldRay& ray = rays[v.root];
        const Vec3d n = [&] { // of the ball where the ray meets it
          const Vec3d q = ray.origin - place.point(centre);
          const double b = q.dot(ray.direction);
          return q + ray.direction * (-b - std::sqrt(b * b - (q.dot(q) - 1)));
        }();
        const Vec3d expected = ray.direction - n * (2 * ray.direction.dot(n));
        worst_mirror = std::max(worst_mirror, angle(scattered.at(0).ray.direction, expected));
        if (is_mirror) {
          REQUIRE(scattered.size() == 1);
          CHECK(scattered[0].weight == Vec3d(1, 1, 1));
        } else {
          REQUIRE(scattered.size() == 2);
          through.push_back(scattered[1]);
          worst_inside = std::max(worst_inside, angle(scattered[1].ray.direction,
                                                      through_ball(place.point(centre), 1, ray, 1.5).inside));
        }
      }
      const std::vector<Vertex> second = next_vertices(lab.shading, through, totals);
      REQUIRE(second.size() == through.size());
      for (const Vertex& v : second) {
        scattered.clear();
        scatter(lab.shading, v, scattered);
        REQUIRE(scattered.size() == 2); // what enters a ball also leaves it
        const BallExit exit = through_ball(place.point(centre), 1, rays[v.root], 1.5);
        worst_out = std::max(worst_out, angle(scattered[1].ray.direction, exit.out));
      }
    }
    const double unit = 1 / (radius * radius);
    CAPTURE(radius, worst_mirror / unit, worst_inside / unit, worst_out / unit);
    CHECK(worst_mirror < 2.5 * unit);
    CHECK(worst_inside < 1.22 * unit);
    CHECK(worst_out < 7.3 * unit);
    if (previous_glass >
        0) { // halving the voxel quarters the errors, but for a different sampling of the worst
      CHECK(worst_out < previous_glass / 3);
      CHECK(worst_mirror < previous_mirror / 3);
    }
    previous_glass = worst_out, previous_mirror = worst_mirror;
  }
}

TEST_CASE("refraction keeps energy, Snell's invariant and reversibility, over all angles and indices") {
  const unsigned seed = 8;
  CAPTURE(seed);
  RandomRays random(seed);
  for (int i = 0; i < 100000; ++i) {
    const double eta = std::exp(random.uniform(-1.5, 1.5));
    const Vec3d n = random.direction();
    Vec3d d = random.direction();
    if (d.dot(n) > 0) d = -d;
    const double sine = d.cross(n).length();
    const Refraction r = refract(d, n, eta);
    if (eta * sine > 1 + 1e-12) {
      REQUIRE(r.reflectance == 1);
      continue;
    }
    if (eta * sine > 1 - 1e-12) continue; // rounding decides
    REQUIRE(r.reflectance >= 0);
    REQUIRE(r.reflectance <= 1);
    REQUIRE(std::fabs(r.direction.length() - 1) < 1e-15);
    // Both sines by cross products, accurate to a few 1e-16.
    REQUIRE(std::fabs(r.direction.cross(n).length() - eta * sine) < 1e-14);
    REQUIRE(std::fabs(r.direction.dot(n.cross(d))) < 1e-15); // in the plane of incidence
    // The way back is the same way with the same losses. Near the critical angle an error u of the sine turns
    // the cosine by sqrt(2u): 1e-7 of sines a few 1e-16 off.
    const Refraction back = refract(-r.direction, -n, 1 / eta);
    REQUIRE((back.direction + d).length() < 1e-7);
    REQUIRE(std::fabs(back.reflectance - r.reflectance) < 1e-6);
  }
  // At normal incidence: ((n1 - n2) / (n1 + n2))^2.
  CHECK(refract(Vec3d(0, 0, -1), Vec3d(0, 0, 1), 1 / 1.5).reflectance == Approx(0.04).epsilon(1e-14));
  // At Brewster's angle, tan i = n2/n1, light in the plane of incidence is not reflected, and of the other
  // sin^2(i - t) is, with i + t = 90 degrees: cos^2(2 i).
  const double brewster = std::atan(1.5);
  const Refraction at = refract(Vec3d(std::sin(brewster), 0, -std::cos(brewster)), Vec3d(0, 0, 1), 1 / 1.5);
  CHECK(at.reflectance == Approx(0.5 * std::pow(std::cos(2 * brewster), 2)).epsilon(1e-12));
  // Grazing light is all reflected.
  CHECK(refract(Vec3d(1, 0, 0), Vec3d(0, 0, 1), 1 / 1.5).reflectance == 1);
}
