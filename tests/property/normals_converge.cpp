// Normals against closed forms: how their error shrinks with the voxel size on smooth shapes, what it is at
// given sizes, and what it is at edges.
//
// Points are hits of random rays through the band's box by `exact`, so they lie on the interpolated surface;
// the reference is the closed-form normal there, which for a point off the true surface is the gradient of
// the exact distance.
#include "levelray/normal/normals.hpp"
#include "levelray/trace/level_set.hpp"
#include "support/catch.hpp"
#include "support/trace_fixtures.hpp"

#include <array>

using namespace levelray;
using namespace levelray::test;

namespace {

double degrees_between(const Vec3d& a, const Vec3d& b) {
  return std::atan2(a.cross(b).length(), a.dot(b)) * 180 / 3.14159265358979323846;
}

struct Errors { // degrees
  double mean = 0, p99 = 0, max = 0;
};

Errors statistics(std::vector<double> errors) {
  std::sort(errors.begin(), errors.end());
  Errors result;
  for (const double e : errors) result.mean += e / static_cast<double>(errors.size());
  result.p99 = errors[errors.size() * 99 / 100];
  result.max = errors.back();
  return result;
}

// The hits of `count` rays from `make_ray`, and a scheme's errors there.
class Surface {
 public:
  template <class MakeRay>
  Surface(const BlockGrid& grid, std::size_t count, MakeRay&& make_ray) : level_set_(grid) {
    while (rays_.size() < count) {
      const WorldRay ray = make_ray();
      const Hit hit = closest_hit(level_set_, ray);
      if (hit) rays_.push_back(ray), hits_.push_back(hit);
    }
  }
  template <class Truth>
  Errors errors(std::string_view scheme, const Truth& truth) const {
    std::vector<Vec3f> normals(rays_.size());
    hit_normals(level_set_, rays_, hits_, scheme, normals);
    std::vector<double> errors;
    for (std::size_t i = 0; i < rays_.size(); ++i)
      errors.push_back(degrees_between(Vec3d(normals[i]), truth(rays_[i].at(hits_[i].t))));
    return statistics(errors);
  }

 private:
  LevelSet level_set_;
  std::vector<WorldRay> rays_;
  std::vector<Hit> hits_;
};

// Random rays through the band's box.
auto all_over(const BlockGrid& grid, unsigned seed) {
  return [random = RandomRays(seed), box = active_box(grid)]() mutable { return random.through(box); };
}

// The fixtures' own places.
Vec3d sphere_normal(const Vec3d& p) {
  return p - Vec3d(-2.3, 1.7, 0.4);
}
auto torus_normal(double radius) {
  return [=](const Vec3d& p) {
    const Vec3d axis = Vec3d(0.3, 0.9, 0.4).normalized(), q = p - Vec3d(-3.2, 1.3, 0.6);
    const Vec3d across = q - axis * q.dot(axis);
    return q - across * (radius / across.length());
  };
}

// The slope of log(error) against log(voxel size), by least squares; sizes in voxels per unit.
double slope(const std::vector<double>& resolutions, const std::vector<double>& errors) {
  double x = 0, y = 0, xx = 0, xy = 0;
  const auto n = static_cast<double>(resolutions.size());
  for (std::size_t i = 0; i < resolutions.size(); ++i) {
    const double a = -std::log(resolutions[i]), b = std::log(errors[i]);
    x += a, y += b, xx += a * a, xy += a * b;
  }
  return (n * xy - x * y) / (n * xx - x * x);
}

bool second_order(std::string_view scheme) {
  return scheme != "analytic" && scheme != "difference-of-interpolations";
}

// A box with random axes, where it is near the origin.
struct Box {
  Vec3d centre, axis[3];
  double half[3];

  Box(RandomRays& random, double size) : centre(random.in_box(Box3d(Vec3d(-1, -1, -1), Vec3d(1, 1, 1)))) {
    axis[0] = random.direction();
    axis[1] = axis[0].cross(random.direction()).normalized();
    axis[2] = axis[0].cross(axis[1]);
    half[0] = size, half[1] = 0.8 * size, half[2] = 0.65 * size;
  }
  double distance(const Vec3d& p) const {
    double outside = 0, inside = -1e9;
    for (int a = 0; a < 3; ++a) {
      const double x = std::fabs((p - centre).dot(axis[a])) - half[a];
      inside = std::max(inside, x), outside += std::max(x, 0.0) * std::max(x, 0.0);
    }
    return std::sqrt(outside) + std::min(inside, 0.0);
  }
  // Of the nearest face. The distance to a convex shape is convex, and a trilinear interpolant is an average
  // of samples whose weighted mean place is the point, so it is nowhere less: the interpolated surface lies
  // within the box, where the nearest face's normal is the exact gradient.
  Vec3d normal(const Vec3d& p) const {
    int nearest = 0;
    double inside = -1e9;
    for (int a = 0; a < 3; ++a) {
      const double x = std::fabs((p - centre).dot(axis[a])) - half[a];
      if (x > inside) inside = x, nearest = a;
    }
    return (p - centre).dot(axis[nearest]) > 0 ? axis[nearest] : -axis[nearest];
  }
  // From outside, against the normal, onto a point spread evenly over the true surface.
  WorldRay onto_surface(RandomRays& random) const {
    const double area[3] = {half[1] * half[2], half[2] * half[0], half[0] * half[1]};
    double which = random.uniform(0, area[0] + area[1] + area[2]);
    int face = 0;
    while (face < 2 && which >= area[face]) which -= area[face++];
    const double side = random.uniform(-1, 1) < 0 ? -1 : 1;
    Vec3d p = centre + axis[face] * (side * half[face]);
    for (const int b : {(face + 1) % 3, (face + 2) % 3}) p += axis[b] * (half[b] * random.uniform(-1, 1));
    WorldRay ray;
    ray.direction = axis[face] * -side;
    ray.origin = p - ray.direction * 6;
    return ray;
  }
};

} // namespace

TEST_CASE("errors of normals on smooth shapes shrink with the voxel size as they should") {
  // Sizes in voxels; from one to the next by the factor 1.5.
  const std::vector<double> sizes{6, 9, 13.5, 20.25};
  std::vector<Surface> spheres, tori;
  std::vector<BlockGrid> grids;
  grids.reserve(2 * sizes.size()); // surfaces keep references
  for (const double size : sizes) {
    const BlockGrid& sphere = grids.emplace_back(sphere_grid(size));
    spheres.emplace_back(sphere, 4000, all_over(sphere, 5));
    const BlockGrid& torus = grids.emplace_back(torus_grid(2 * size, size * (2. / 3)));
    tori.emplace_back(torus, 4000, all_over(torus, 6));
  }
  for (const std::string& scheme : method_names<NormalSchemes>()) {
    std::vector<double> sphere, torus; // mean errors
    for (std::size_t i = 0; i < sizes.size(); ++i) {
      sphere.push_back(spheres[i].errors(scheme, sphere_normal).mean);
      torus.push_back(tori[i].errors(scheme, torus_normal(2 * sizes[i])).mean);
    }
    const double of_sphere = slope(sizes, sphere), of_torus = slope(sizes, torus);
    CAPTURE(scheme, sphere, torus, of_sphere, of_torus);
    // 1.9 and 0.9 for 2 and 1: terms of the next order are 1/size of the leading one, at the coarse end a
    // tenth.
    if (second_order(scheme)) {
      CHECK(of_sphere >= 1.9);
      CHECK(of_torus >= 1.9);
    } else {
      CHECK(of_sphere >= 0.9);
      CHECK(of_torus >= 0.9);
      CHECK(of_sphere <= 1.5); // which would be a surprise to explain
    }
  }
}

TEST_CASE("errors of normals on a sphere and thin tori are those of the study of methods") {
  // The study's table: degrees, printed with two digits. It does not say how large or how turned its tori are
  // and how its points are spread. Turning ours changes the means by 5 % at most; the tube's other radius,
  // the mean curvature of its inner and outer sides, and the spread of points over them account for the rest
  // of the 25 % allowed here: an error of order h^2 is up to twice as large on one side as on the other.
  struct Row {
    std::string_view scheme;
    double sphere, torus_3, torus_1_5; // means
  };
  const Row rows[] = {
      {"analytic", 0.89, 3.6, 7.4},
      {"interpolation-of-differences", 0.014, 0.52, 1.6},
      {"offset-differences", 0.007, 0.23, 1.1},
      {"dual-voxel", 0.014, 0.45, 2.1},
      {"tricubic-b-spline", 0.0005, 0.13, 0.41}, // printed 0.000: below half of its last digit
      {"sharp-features", 0.007, 0.23, 1.1}};     // ours; no crease here: as offset differences
  const BlockGrid sphere = sphere_grid(20), torus_3 = torus_grid(18, 3), torus_1_5 = torus_grid(18, 1.5);
  const Surface on_sphere(sphere, 6000, all_over(sphere, 5)), on_3(torus_3, 6000, all_over(torus_3, 5)),
      on_1_5(torus_1_5, 6000, all_over(torus_1_5, 5));
  for (const Row& row : rows) {
    const Errors a = on_sphere.errors(row.scheme, sphere_normal),
                 b = on_3.errors(row.scheme, torus_normal(18)),
                 c = on_1_5.errors(row.scheme, torus_normal(18));
    CAPTURE(row.scheme, a.mean, a.max, b.mean, b.p99, b.max, c.mean, c.p99);
    CHECK(a.mean <= row.sphere * 1.1);
    CHECK(std::fabs(b.mean / row.torus_3 - 1) <= 0.25);
    CHECK(std::fabs(c.mean / row.torus_1_5 - 1) <= 0.25);
  }
}

TEMPLATE_LIST_TEST_CASE("normals of continuous schemes do not jump at faces or in the middles of cells", "",
                        NormalSchemes) {
  if (!TestType::smooth || TestType::name == "sharp-features")
    return; // which jumps at what it takes for creases
  const BlockGrid grid = torus_grid(12, 2.5);
  const LevelSet level_set(grid);
  RandomRays random(9);
  constexpr double beside = 1e-7;
  int tried = 0;
  while (tried < 2000) {
    const WorldRay ray = random.through(active_box(grid));
    const Hit hit = closest_hit(level_set, ray);
    if (!hit) continue;
    CellPosition low;
    low.cell = hit.cell;
    for (double& x : low.local) x = random.uniform(0, 1);
    const int axis = tried % 3;
    CellPosition high = low;
    if (++tried % 2) {
      low.local[axis] = 1, high.cell[axis] += 1, high.local[axis] = 0;
    } else { // where the dual voxel and the half-voxel stencils change
      low.local[axis] = 0.5 - beside, high.local[axis] = 0.5 + beside;
    }
    const Vec3d a = unit_normal<TestType>(Neighbourhood(grid, low.cell), low),
                b = unit_normal<TestType>(Neighbourhood(grid, high.cell), high);
    // Floats of 2^-23 in sums of some ten terms, over gradients that are 1/10 at the least this near a
    // surface with radii above 2.5 voxels; and a turn of at most one radian per voxel over 2 * 10^-7 of it.
    REQUIRE((a - b).length() < 10 * 10 * 0x1p-23 + 2 * beside);
  }
}

TEST_CASE("only the scheme for sharp features keeps a rotated box's faces up to its edges") {
  constexpr unsigned seed = 77;
  CAPTURE(seed);
  RandomRays random(seed);
  for (const double size : {10.0, 20.0})
    for (int turn = 0; turn < 4; ++turn) {
      const Box box(random, size);
      const double e = size * 1.4 + 5;
      const BlockGrid grid = sample_grid([&](const Vec3d& p) { return box.distance(p); }, 1, 3,
                                         Box3d(Vec3d(-e, -e, -e), Vec3d(e, e, e)));
      const Surface surface(grid, 5000, [&] { return box.onto_surface(random); });
      for (const std::string& scheme : method_names<NormalSchemes>()) {
        const Errors errors = surface.errors(scheme, [&](const Vec3d& p) { return box.normal(p); });
        CAPTURE(size, turn, scheme, errors.mean, errors.p99, errors.max);
        if (scheme == "sharp-features") {
          CHECK(errors.p99 <= 2);
          CHECK(errors.mean <= 0.5);
        } else {
          CHECK(errors.p99 >= 20); // half of what a blend of two faces is off by
          CHECK(errors.max >= 40);
        }
      }
    }
}

TEST_CASE("sharp features tell the two sides of a thin plate apart") {
  const Vec3d n = Vec3d(0.42, 0.31, 0.85).normalized(), centre(0.4, -2.7, 1.1); // those of slab_grid
  for (const double thickness : {0.8, 1.5, 2.5}) {
    const BlockGrid grid = slab_grid(thickness);
    RandomRays random(21);
    const Surface surface(grid, 4000, [&] { // clear of the rim, which is 20 voxels from the middle
      const Vec3d u = n.cross(Vec3d(0, 0, 1)).normalized(), v = n.cross(u);
      const double side = random.uniform(-1, 1) < 0 ? -1 : 1;
      WorldRay ray;
      ray.direction = n * -side;
      ray.origin = centre + n * (side * 5) + u * random.uniform(-15, 15) + v * random.uniform(-15, 15);
      return ray;
    });
    const auto truth = [&](const Vec3d& p) { return (p - centre).dot(n) > 0 ? n : -n; };
    const Errors errors = surface.errors("sharp-features", truth);
    CAPTURE(thickness, errors.mean, errors.p99, errors.max);
    CHECK(errors.p99 <= 2);
  }
}
