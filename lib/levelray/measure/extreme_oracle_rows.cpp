// Who judges the judges of the suite `extremes`? Identities, closed forms, and methods known to be wrong.
#include "levelray/measure/exact_number.hpp"
#include "levelray/measure/extremes.hpp"
#include "levelray/measure/made_grids.hpp"
#include "levelray/measure/mesh_judge.hpp"
#include "levelray/measure/ray_judge.hpp"
#include "levelray/measure/ray_trial.hpp"

#include <cmath>
#include <fmt/format.h>
#include <random>

namespace levelray {

namespace {

// Laws of arithmetic, on doubles of all sizes, which hold to the last bit or not at all.
ExtremeOutcome exact_numbers(const ExtremeSettings& settings) {
  ExtremeTally tally;
  std::mt19937_64 random(settings.seed);
  const auto number = [&] {
    const double mantissa = 1 + static_cast<double>(random() >> 12) * 0x1p-52;
    const double x = random() % 3 ? mantissa : std::round(4 * mantissa);
    return std::ldexp(random() % 2 ? x : -x,
                      static_cast<int>(random() % 1800) - 900 + (random() % 2 ? 0 : 20));
  };
  for (int i = 0; i < 4000; ++i) {
    const double x = number(), y = i % 3 ? number() : std::ldexp(x, static_cast<int>(random() % 60) - 30),
                 z = number();
    const ExactNumber a(x), b(y), c(z);
    const auto check = [&](bool right, const char* law) {
      tally.check(right, [&] { return fmt::format("{} with a {:a} b {:a} c {:a}", law, x, y, z); });
    };
    tally.add();
    check(a.sign() == (x > 0) - (x < 0) && (a - b).sign() == (x > y) - (x < y), "the sign of a, or a - b");
    check(((a + b) - a - b).sign() == 0, "(a + b) - a - b = 0");
    check(((a + b) * c - (a * c + b * c)).sign() == 0, "(a + b) c = a c + b c");
    check(((a - b) * (a + b) - (a * a - b * b)).sign() == 0, "(a - b)(a + b) = a a - b b");
    // One unit of the smallest double more is seen.
    check((a * b + ExactNumber(5e-324) - a * b).sign() == 1, "a b + 2^-1074 > a b");
  }
  return tally.outcome();
}

// Planes x . n = c with n of small whole numbers: samples, and so the interpolant, are exactly linear, so
// that t = (c - o . n) / (d . n).
ExtremeOutcome planes(const ExtremeSettings& settings) {
  ExtremeTally tally("voxel");
  for (const Vec3i& n : {Vec3i(1, 0, 0), Vec3i(2, -1, 1), Vec3i(-1, -3, 2), Vec3i(0, 1, 1)}) {
    const BlockGrid grid = grid_of_samples(
        Vec3i(-10, -10, -10), Vec3i(21, 21, 21),
        [&](int i, int j, int k) { return static_cast<float>(i * n.x + j * n.y + k * n.z) - 0.25f; }, 100);
    const RayJudge judge(grid);
    ExtremeTally unused;
    RayTrial trial(grid, fmt::format("plane ({}, {}, {})", n.x, n.y, n.z), settings, unused, 1, 0);
    const Vec3d normal(n);
    for (int i = 0; i < 500; ++i) {
      WorldRay ray;
      ray.origin = trial.random_place() * 0.9, ray.direction = trial.random_direction();
      const Extended slope = Vec3x(ray.direction).dot(Vec3x(normal)),
                     start = Vec3x(ray.origin).dot(Vec3x(normal)) - 0.25L;
      const Extended t = -start / slope;
      const Vec3d at = ray.at(static_cast<double>(t));
      if (!(t > 0.01L && std::fabs(at.x) < 10 && std::fabs(at.y) < 10 && std::fabs(at.z) < 10)) continue;
      const RayAnswer answer = judge.ask(ray);
      tally.add();
      tally.error(static_cast<double>(std::fabs(answer.root - t)));
      tally.check(answer.side == (start > 0 ? 1 : -1) && std::fabs(answer.root - t) <= 0x1p-50L &&
                      answer.earliest <= t && t <= answer.latest,
                  [&] {
                    return trial.describe(ray) + fmt::format(": judged {:a}, right is {:a}",
                                                             static_cast<double>(answer.root),
                                                             static_cast<double>(t));
                  });
      // A double just before it, and just behind.
      const double before = std::nextafter(static_cast<double>(t), 0.0),
                   behind = std::nextafter(static_cast<double>(t), 1e9);
      tally.check(judge.sign_at(ray, before) == answer.side && judge.sign_at(ray, behind) == -answer.side,
                  [&] {
                    return trial.describe(ray) +
                           fmt::format(": exact signs beside {:a} are wrong", static_cast<double>(t));
                  });
    }
  }
  return tally.outcome();
}

ExtremeOutcome signs_and_values(const ExtremeSettings& settings) {
  ExtremeTally tally;
  for (const NamedGrid& each : study_grids()) {
    RayTrial trial(each.grid, each.name, settings, tally);
    for (int i = 0; i < 1500; ++i) {
      const WorldRay ray = trial.random_ray();
      const double t = (trial.random_place() - ray.origin).length();
      Extended margin = 0;
      const Extended value = trial.judge().value_at(ray, t, margin);
      tally.add();
      // Long double is far better than the margin of doubles.
      if (std::fabs(value) > 0x1p-6L * margin)
        tally.check(trial.judge().sign_at(ray, t) == (value > 0 ? 1 : -1),
                    [&] { return trial.describe(ray) + fmt::format(": sign and value differ at {:a}", t); });
    }
  }
  return tally.outcome();
}

// A cube of side 2 about the origin, by the largest coordinate; winding 1 and 0.
ExtremeOutcome mesh_sums(const ExtremeSettings& settings) {
  ExtremeTally tally("unit");
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i) mesh.vertices.emplace_back(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
  mesh.triangles = {{0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}};
  std::mt19937_64 random(settings.seed);
  const auto coordinate = [&] { return 4 * (static_cast<double>(random() >> 11) * 0x1p-53) - 2; };
  for (int i = 0; i < 2000; ++i) {
    const Vec3d p(coordinate(), coordinate(), coordinate());
    const double expected = std::fabs(box_distance(p, Vec3d(1, 1, 1))),
                 distance = static_cast<double>(mesh_distance(mesh, p));
    const bool inside = box_distance(p, Vec3d(1, 1, 1)) < 0;
    tally.add();
    tally.error(std::fabs(distance - expected));
    tally.check(
        std::fabs(distance - expected) <= 0x1p-50 &&
            std::fabs(mesh_winding(mesh, p) - (inside ? 1 : 0)) <= 0x1p-50L,
        [&] { return fmt::format("at ({:a}, {:a}, {:a}) the cube is {:a} away", p.x, p.y, p.z, distance); });
  }
  return tally.outcome();
}

// Red is what the rows about rays must be for methods that are approximate.
ExtremeOutcome says_no(const ExtremeSettings& settings) {
  ExtremeTally tally;
  for (const char* name : {"midpoint", "false-position-1", "newton"}) {
    ExtremeSettings other = settings;
    other.intersector = name;
    for (const ExtremeRow& row : extreme_ray_rows()) {
      if (row.name != "adversarial" && row.name != "diagonals") continue;
      tally.add();
      tally.check(run_extreme(row, other).outcome.verdict == ExtremeVerdict::red,
                  [&] { return fmt::format("row {} finds nothing wrong with {}", row.name, name); });
    }
  }
  return tally.outcome();
}

} // namespace

std::vector<ExtremeRow> extreme_oracle_rows() {
  return {
      {"oracle", "exact-numbers", "The judge's exact numbers keep the laws of arithmetic, and see 2^-1074.",
       exact_numbers},
      {"oracle", "planes",
       "The judge's hits of planes are those of their closed form, to 2^-50; exact signs tell doubles beside "
       "them apart.",
       planes},
      {"oracle", "signs-and-values", "The judge's exact signs and its long double agree.", signs_and_values},
      {"oracle", "mesh-sums", "The judge's distances and windings of a cube are the closed form's.",
       mesh_sums},
      {"oracle", "says-no", "Intersectors that lose surfaces, or miss their place, are found out.", says_no}};
}

} // namespace levelray
