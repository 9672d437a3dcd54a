#include "levelray/intersect/intersectors.hpp"
#include "levelray/measure/analytic_suite.hpp"
#include "levelray/measure/interleaved_times.hpp"
#include "levelray/measure/ray_sets.hpp"
#include "levelray/normal/normals.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <cmath>

using namespace levelray;

namespace {

Hit hit_at(double t) {
  Hit hit;
  hit.status = HitStatus::hit;
  hit.t = t;
  return hit;
}

const Reference& shape_named(const std::vector<Reference>& all, const std::string& name) {
  return *std::find_if(all.begin(), all.end(), [&](const Reference& r) { return r.name == name; });
}

} // namespace

TEST_CASE("quantiles are values that so many do not exceed") {
  std::vector<double> values;
  for (int i = 1000; i >= 1; --i) values.push_back(i);
  const ErrorStatistics s = error_statistics(values);
  CHECK(s.count == 1000);
  CHECK(s.mean == 500.5);
  CHECK(s.p50 == 500);
  CHECK(s.p99 == 990);
  CHECK(s.p999 == 999);
  CHECK(s.max == 1000);
  CHECK(error_statistics({7}).p999 == 7);
  CHECK(error_statistics({}).count == 0);
}

TEST_CASE("slopes of powers are their exponents") {
  CHECK(log_log_slope({1, 0.5, 0.25}, {3, 0.75, 0.1875}) == Approx(2).margin(1e-12));
  CHECK(std::isnan(log_log_slope({1}, {3})));
  CHECK(std::isnan(log_log_slope({1, 0.5}, {3, 0})));
  CHECK(std::isnan(log_log_slope({1, 1}, {3, 2})));
}

TEST_CASE("hits are judged by the shape and by what sampling can know of it") {
  const std::vector<Reference> all = all_references();
  const Reference& ball = shape_named(all, "sphere"); // radius 0.5
  const double h = 1.0 / 32;
  const SampledReference sampled{&ball, h, 3 * h};
  const Vec3d centre = (ball.bounds.min + ball.bounds.max) * 0.5;
  // A ray along x at that distance from the centre, beginning 2 before it.
  const auto ray_at = [&](double distance) {
    WorldRay ray;
    ray.origin = centre + Vec3d(-2, distance, 0);
    ray.direction = Vec3d(1, 0, 0);
    return ray;
  };
  const auto judged = [&](double distance, const Hit& hit) {
    const WorldRay ray = ray_at(distance);
    const Chord chord = ball.chord(ray);
    return judge_against_shape(sampled, {&ray, 1}, {&chord, 1}, {&hit, 1});
  };
  // E at the surface: h^2/8 of 2/(0.5 - sqrt(3) h), about 5.5e-4.
  const double error = sampled.error(centre + Vec3d(0, 0.5, 0));
  CHECK(error == Approx(h * h / 8 * 2 / (0.5 - std::sqrt(3.0) * h)).epsilon(1e-3));

  CHECK(judged(0.7, Hit()).confusion.misses == 1);
  CHECK(judged(0.7, hit_at(2)).confusion.phantoms == 1);
  CHECK(judged(0.5 + 0.5 * error, hit_at(2)).confusion.unresolved == 1); // sampling may find the ball there
  CHECK(judged(0.5 + 2 * error, hit_at(2)).confusion.phantoms == 1);
  CHECK(judged(0.2, Hit()).confusion.leaks == 1);
  CHECK(judged(0.5 - 0.5 * error, Hit()).confusion.unresolved == 1);
  CHECK(judged(0.5 - 2 * error, Hit()).confusion.leaks == 1);
  const Judgement near = judged(0, hit_at(1.5 + 0.1 * h));
  CHECK(near.confusion.hits == 1);
  REQUIRE(near.t_errors_voxels.size() == 1);
  CHECK(near.t_errors_voxels[0] == Approx(0.1));
  CHECK(near.distance_errors_voxels[0] == Approx(0.1));
  CHECK(judged(0, hit_at(2.5 + h)).confusion.wrong == 1); // behind the ball
  CHECK(judged(0, hit_at(1.5 - 1.8 * h)).confusion.wrong ==
        1); // in front of it, by more than a cell's diagonal
  CHECK(judged(0, hit_at(1.5 - 1.7 * h)).confusion.hits == 1);

  const Hit exact[] = {hit_at(1), hit_at(1), hit_at(1), Hit(), Hit()};
  const Hit hits[] = {hit_at(1 + h), hit_at(1 + 2 * h), Hit(), hit_at(1), Hit()};
  const Confusion grid = judge_against_grid(h, exact, hits).confusion;
  CHECK(grid.hits == 1);
  CHECK(grid.wrong == 1);
  CHECK(grid.leaks == 1);
  CHECK(grid.phantoms == 1);
  CHECK(grid.misses == 1);
}

TEST_CASE("random chords are the same for a seed, and pass through the ball that they are meant for") {
  const Box3d box(Vec3d(-1, -2, 0), Vec3d(2, 2, 1));
  const auto a = random_chords(box, 500, 7), b = random_chords(box, 500, 7), c = random_chords(box, 500, 8);
  REQUIRE(a.size() == 500);
  const double radius = 1.1 * (box.max - box.min).length() / 2;
  const Vec3d centre = (box.max + box.min) * 0.5;
  int equal = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    CHECK(a[i].origin == b[i].origin);
    CHECK(a[i].direction == b[i].direction);
    equal += a[i].origin == c[i].origin;
    CHECK(a[i].direction.length() == Approx(1).margin(1e-15));
    CHECK((a[i].origin - centre).length() == Approx(radius).margin(1e-12));
    CHECK((centre - a[i].origin).dot(a[i].direction) > 0);
  }
  CHECK(equal == 0);
  std::vector<std::array<double, 2>> pixels = tiled_pixels(50);
  CHECK(pixels.size() == 2500);
  std::sort(pixels.begin(), pixels.end());
  CHECK(std::adjacent_find(pixels.begin(), pixels.end()) == pixels.end());
}

TEST_CASE("works take turns as often as they should") {
  int a = 0, b = 0;
  const std::vector<TimeSpread> times = interleaved_times({[&] { ++a; }, [&] { ++b; }}, 5);
  CHECK(a == 6);
  CHECK(b == 6);
  REQUIRE(times.size() == 2);
  CHECK(times[0].min <= times[0].median);
  CHECK(times[0].median <= times[0].max);
}

TEST_CASE("the analytic suite has a row for every method and finds what is known of them") {
  AnalyticSettings settings;
  settings.resolutions = {24, 48, 96};
  settings.shapes = {"sphere", "capsule"};
  settings.image_size = 24;
  settings.chords = 1500;
  settings.repetitions = 0;
  INFO("seed " << settings.seed);
  double progress = 0;
  const AnalyticResult result = run_analytic_suite(settings, [&](double done) { progress = done; });
  CHECK(progress == 1);
  CHECK(result.solvers.size() == 2 * 3 * std::tuple_size_v<Intersectors>);
  CHECK(result.normals.size() == 2 * 3 * std::tuple_size_v<NormalSchemes>);
  CHECK(result.primary_rays == 24 * 24);
  for (const SolverRow& row : result.solvers) {
    CAPTURE(row.method, row.at.shape, row.at.resolution);
    CHECK(row.shape.rays() == 24 * 24 + 1500);
    CHECK(row.grid.rays() == 24 * 24 + 1500);
    CHECK(row.t.count == row.shape.hits);
    if (row.method != Exact::name) continue;
    CHECK(row.shape.hits > 100);
    CHECK(row.shape.lost() == 0);
    CHECK(row.grid.lost() == 0);
    CHECK(row.grid_t.max == 0);
    // On the grid's surface the value is within the interpolation error: h^2/8 of 2/(r - sqrt(3) h) in all.
    const double h = row.at.voxel_size, radius = row.at.shape == "sphere" ? 0.5 : 0.18;
    CHECK(row.distance.max <= h / 4 / (radius - std::sqrt(3.0) * h) + 1e-6);
  }
  for (const AccelerationRow& row : result.accelerations) {
    CAPTURE(row.method, row.rays);
    CHECK(row.different == 0);
  }
  int slopes = 0;
  for (const Convergence& curve : result.convergence) {
    CAPTURE(curve.shape, curve.method, curve.quantity, curve.mean_slope);
    REQUIRE(curve.voxel_sizes.size() == 3);
    const bool second_order = curve.method == Exact::name ||
                              curve.method == InterpolationOfDifferences::name ||
                              curve.method == OffsetDifferences::name;
    if (!second_order) continue;
    ++slopes;
    CHECK(curve.finest_slope == Approx(std::log2(curve.means[1] / curve.means[2])));
    // 2 in the limit. With some hundred hits the grazing ones, whose error is that of a square root, move the
    // mean; the median has none of them.
    CHECK((curve.median_slope > 1.9 && curve.median_slope < 2.2));
  }
  CHECK(slopes == 2 * 4);
  settings.shapes = {"cube"};
  CHECK_THROWS_WITH(run_analytic_suite(settings),
                    Catch::Contains("unknown shape 'cube'; there are sphere, "));
}
