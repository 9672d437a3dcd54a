// Rays of the suite `extremes`: directions, origins, intervals, and lines of the lattice.
#include "levelray/intersect/exact.hpp"
#include "levelray/measure/extremes.hpp"
#include "levelray/measure/made_grids.hpp"
#include "levelray/measure/ray_trial.hpp"

#include <cfloat>
#include <cmath>
#include <fmt/format.h>

namespace levelray {

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double no_number = std::numeric_limits<double>::quiet_NaN();

WorldRay ray_from(const Vec3d& origin, const Vec3d& direction, double t_min = 0, double t_max = infinite) {
  WorldRay ray;
  ray.origin = origin, ray.direction = direction, ray.t_min = t_min, ray.t_max = t_max;
  return ray;
}

// A row that judges rays through each of the study's grids.
ExtremeRow judged(const char* name, const char* expected, std::function<void(RayTrial&)> rays) {
  return {"rays", name, expected, [=](const ExtremeSettings& settings) {
            ExtremeTally tally("voxel");
            for (const NamedGrid& each : study_grids()) {
              RayTrial trial(each.grid, each.name, settings, tally);
              rays(trial);
            }
            return tally.outcome();
          }};
}

// One or two components replaced, in rays whose others aim at the surface.
void replace_components(RayTrial& trial, std::initializer_list<double> values) {
  for (const double value : values)
    for (int mask = 1; mask < 7; ++mask)
      for (int i = 0; i < 12; ++i) {
        WorldRay ray = trial.random_ray();
        const Vec3d target = trial.surface()[static_cast<std::size_t>(i) % trial.surface().size()];
        Vec3d place = trial.grid().transform.to_voxel(target);
        for (int a = 0; a < 3; ++a) {
          if (mask >> a & 1) ray.direction[a] = i % 2 ? -value : value;
          if (i % 3 == 0) place[a] = std::round(place[a]);
        }
        ray.origin = trial.grid().transform.to_world(place) - ray.direction * (64 / ray.direction.length());
        trial.judge(ray);
      }
}

void from_lattice(RayTrial& trial) {
  for (int i = 0; i < 120; ++i) {
    Vec3d place = trial.grid().transform.to_voxel(
        trial.surface()[static_cast<std::size_t>(i) % trial.surface().size()]);
    // A sample, an edge, a face, the middle of a cell; up to 3 voxels beside the surface.
    for (int a = 0; a < 3; ++a) {
      place[a] = std::floor(place[a] + trial.uniform(-3, 3)) + (a < i % 4 ? 0.5 : 0);
      const int ulp = static_cast<int>(trial.uniform(-1, 2));
      if (ulp) place[a] = std::nextafter(place[a], ulp < 0 ? -infinite : infinite);
    }
    trial.judge(ray_from(place, trial.random_direction()));
    Vec3d axis(0, 0, 0);
    axis[i % 3] = i % 2 ? 1 : -1;
    trial.judge(ray_from(place, axis));
    trial.judge(ray_from(place, Vec3d(i % 2 ? 1 : -1, i % 3 ? 1 : -1, i % 5 ? 1 : 0)));
  }
}

// Where the ray through a surface point meets it first by the judge: `t` for intervals about it.
void cut_intervals(RayTrial& trial) {
  for (int i = 0; i < 60; ++i) {
    WorldRay ray = trial.random_ray();
    ray.direction = trial.surface()[static_cast<std::size_t>(i) % trial.surface().size()] - ray.origin;
    const RayAnswer answer = trial.judge().ask(ray);
    if (!answer.is_clear()) continue;
    const double t = static_cast<double>(answer.root);
    for (const double min : {0.0, -1.0, -infinite, -DBL_MAX, t / 2, std::nextafter(t, 0.0), t,
                             std::nextafter(t, 2 * t), 1.5 * t})
      for (const double max : {t / 2, std::nextafter(t, 0.0), t, std::nextafter(t, 2 * t), 2 * t,
                               double{FLT_MAX}, DBL_MAX, infinite}) {
        ray.t_min = min, ray.t_max = max;
        if (min <= max) trial.judge(ray);
      }
    ray.t_min = t, ray.t_max = std::nextafter(t, 0.0);
    trial.judge_nothing(ray);
    ray.t_min = 2, ray.t_max = -2;
    trial.judge_nothing(ray);
  }
}

void no_rays(RayTrial& trial) {
  const WorldRay ray = ray_from(trial.surface()[0] - Vec3d(40, 0, 0), Vec3d(1, 0, 0));
  for (const double zero : {0.0, -0.0, 5e-324, -5e-324, 1e-310}) {
    WorldRay still = ray;
    still.direction = Vec3d(zero, -zero, zero);
    trial.judge_nothing(still);
  }
  for (const double bad : {no_number, infinite, -infinite})
    for (int a = 0; a < 3; ++a) {
      WorldRay lost = ray;
      lost.direction[a] = bad;
      trial.judge_nothing(lost);
      lost = ray;
      lost.origin[a] = bad;
      trial.judge_nothing(lost);
    }
  for (const auto& [min, max] : {std::pair{no_number, infinite},
                                 {0.0, no_number},
                                 {no_number, no_number},
                                 {5.0, 4.0},
                                 {infinite, infinite},
                                 {-infinite, -infinite},
                                 {infinite, -infinite}}) {
    WorldRay never = ray;
    never.t_min = min, never.t_max = max;
    trial.judge_nothing(never);
  }
}

// x <= 5, its surface being samples' own plane: f = x - 5 exactly, cut off by the grid's end.
ExtremeOutcome along_zeros(const ExtremeSettings& settings) {
  ExtremeTally tally("voxel");
  for (int axis = 0; axis < 3; ++axis) {
    const BlockGrid grid = grid_of_samples(
        Vec3i(-9, -9, -9), Vec3i(20, 20, 20),
        [=](int i, int j, int k) {
          return static_cast<float>((axis == 0 ? i : axis == 1 ? j : k) - 5);
        },
        16);
    RayTrial trial(grid, fmt::format("plane of zeros across axis {}", axis), settings, tally);
    for (int i = 0; i < 60; ++i) {
      // In the plane: on samples, on the grid's edges, within faces; from outside and from its middle.
      Vec3d place = trial.random_place(), direction = trial.random_direction();
      place[axis] = 5, direction[axis] = i % 7 == 0 ? -0.0 : 0;
      const int other = (axis + 1 + i % 2) % 3;
      if (i % 3 == 0) place[other] = std::round(place[other]);
      if (i % 5 == 0) direction = Vec3d(0, 0, 0), direction[other] = i % 2 ? 1 : -1;
      const bool from_it = i % 4 == 0;
      const WorldRay ray = ray_from(from_it ? place : place - direction * 64, direction);
      trial.judge(ray);
      const Hit hit = closest_hit(trial.level_set(), ray, settings.intersector);
      // Exact: the ray is on the surface from its first point within the samples on, hence from where the
      // cells begin whose other corners are +16: f falls from there to 0 at the samples.
      if (tally.check(bool(hit),
                      [&] { return trial.describe(ray) + ": misses the plane that it lies in"; }) &&
          from_it)
        tally.check(hit.t == 0,
                    [&] { return trial.describe(ray) + ": begins on the surface, but hits later"; });
    }
  }
  return tally.outcome();
}

// Rays along each other's line meet the same crossings.
ExtremeOutcome reversed(const ExtremeSettings& settings) {
  ExtremeTally tally("voxel");
  std::vector<SurfacePlace> there, back;
  for (const NamedGrid& each : study_grids()) {
    RayTrial trial(each.grid, each.name, settings, tally);
    for (int i = 0; i < 800; ++i) {
      WorldRay ray = trial.random_ray();
      ray.t_max = 2 * (trial.surface()[0] - ray.origin).length() + 40;
      WorldRay other = ray;
      other.origin = ray.at(ray.t_max), other.direction = -ray.direction;
      all_hits(trial.level_set(), ray, there);
      all_hits(trial.level_set(), other, back);
      tally.add();
      // Grazes may be two crossings one way and none the other; then f is near 0 there. Only rays whose
      // places are all sure, by certify's margin on either side of 0 at both directions, must agree.
      bool sure = true;
      Extended margin = 0;
      for (const std::vector<SurfacePlace>* places : {&there, &back})
        for (std::size_t k = 0; k + 1 < places->size(); ++k) {
          const WorldRay& own = places == &there ? ray : other;
          const double middle = ((*places)[k].t + (*places)[k + 1].t) / 2;
          sure &= std::fabs(trial.judge().value_at(own, middle, margin)) > 64 * margin;
        }
      if (!sure) continue;
      if (!tally.check(there.size() == back.size() || there.empty() || back.empty(), [&] {
            return trial.describe(ray) +
                   fmt::format(": {} places, and {} on the way back", there.size(), back.size());
          }))
        break;
      if (there.empty() != back.empty()) {
        const RayAnswer answer = trial.judge().ask(there.empty() ? other : ray);
        tally.check(!(answer.latest < infinite),
                    [&] { return trial.describe(ray) + ": nothing one way, the surface the other"; });
        continue;
      }
      for (std::size_t k = 0; k < there.size(); ++k) {
        const double off = std::fabs(there[k].t + back[back.size() - 1 - k].t - ray.t_max);
        tally.error(off);
        // Where the ray crosses at a slope of 2^-10 and more, rounding of 2^-43 of a voxel moves it by no
        // more than 2^-33; less steep ones are known by the values between places that were looked at above.
        tally.check(off <= 1e-6, [&] {
          return trial.describe(ray) + fmt::format(": place {} is {:.3g} away on the way back", k, off);
        });
      }
    }
  }
  return tally.outcome();
}

} // namespace

std::vector<ExtremeRow> extreme_ray_rows() {
  return {
      judged("components-zero", "Directions with one or two components of 0 or -0 hit what the judge says.",
             [](RayTrial& trial) {
               replace_components(trial, {0.0, -0.0});
             }),
      judged("components-tiny",
             "Components of 1e-40, 1e-30, 1e-200 and the least denormal hit what the judge says.",
             [](RayTrial& trial) {
               replace_components(trial, {1e-40, 1e-30, 1e-200, 5e-324});
             }),
      judged("direction-lengths", "Directions 1e-280 to 1e300 long hit, t in units of that length.",
             [](RayTrial& trial) {
               for (const double length : {1e-280, 1e-40, 1e-20, 1e-3, 1e20, 1e40, 1e300})
                 for (int i = 0; i < 60; ++i) {
                   WorldRay ray = trial.random_ray();
                   ray.direction *= length;
                   trial.judge(ray);
                 }
             }),
      judged("no-rays",
             "Zero, denormal, infinite and NaN directions, NaN and infinite origins and bounds, and "
             "empty intervals find nothing, as documented (trace/trace.hpp).",
             no_rays),
      judged("origins-on-lattice",
             "Origins on samples, edges, faces and one unit in the last place beside them hit.",
             from_lattice),
      judged("origins-inside", "Rays that begin inside find where they come out.",
             [](RayTrial& trial) {
               for (int i = 0, found = 0; i < 40000 && found < 150; ++i) {
                 WorldRay ray = ray_from(trial.random_place(), trial.random_direction());
                 Extended margin = 0;
                 if (!(trial.judge().value_at(ray, 0, margin) < -margin)) continue;
                 ++found;
                 trial.judge(ray);
               }
             }),
      judged("origins-on-surface",
             "Rays from the surface, to within rounding, hit there or leave it as the judge allows.",
             [](RayTrial& trial) {
               for (int i = 0; i < 300; ++i)
                 trial.judge(ray_from(trial.surface()[static_cast<std::size_t>(i) % trial.surface().size()],
                                      trial.random_direction()));
             }),
      judged("origins-far",
             "Origins 1e3, 1e6, 1e9 and 1e12 voxels away hit, as well as coordinates of that size allow.",
             [](RayTrial& trial) {
               for (const double distance : {1e3, 1e6, 1e9, 1e12})
                 for (int i = 0; i < 100; ++i) {
                   const Vec3d target = trial.surface()[static_cast<std::size_t>(i) % trial.surface().size()];
                   Vec3d d = trial.random_direction();
                   if (i % 4 == 0) d = Vec3d(0, 0, 0), d[i % 3] = i % 8 ? 1 : -1;
                   trial.judge(ray_from(target - d * distance, d));
                 }
             }),
      judged("intervals",
             "Intervals that are single numbers, begin before 0, are cut at the hit or one unit beside "
             "it, or have no end, are closed; empty ones find nothing.",
             cut_intervals),
      {"rays", "along-zeros", "Rays within a plane of zero samples hit it where they come to it.",
       along_zeros},
      judged("diagonals", "Rays along all axes and diagonals through corners of cells and blocks hit.",
             [](RayTrial& trial) {
               for (int x = -1; x <= 1; ++x)
                 for (int y = -1; y <= 1; ++y)
                   for (int z = -1; z <= 1; ++z)
                     for (int i = 0; i < 12; ++i) {
                       const Vec3d d(x, y, z);
                       if (d == Vec3d(0, 0, 0)) continue;
                       // Corners of blocks, of nodes, of cells.
                       const double step = i < 4 ? 4 : i < 6 ? 16 : 1;
                       const Vec3d c(step * std::round(trial.uniform(-8, 8) / step),
                                     step * std::round(trial.uniform(-8, 8) / step),
                                     step * std::round(trial.uniform(-8, 8) / step));
                       trial.judge(ray_from(c - d * 64, d));
                     }
             }),
      judged("adversarial",
             "Rays through vertices, edges and faces, tangents, from the surface and cut off at it, "
             "exactly and off by units in the last place.",
             [](RayTrial& trial) { trial.judge_all_kinds(150); }),
      {"rays", "reversed", "Rays both ways along a line meet the same crossings.", reversed},
  };
}

} // namespace levelray
