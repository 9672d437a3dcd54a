// What must not change, of the suite `extremes`: accelerations, symmetries, both ways along a line.
#include "levelray/intersect/intersectors.hpp"
#include "levelray/measure/extremes.hpp"
#include "levelray/measure/made_grids.hpp"
#include "levelray/measure/ray_sets.hpp"
#include "levelray/measure/ray_trial.hpp"
#include "levelray/trace/certified_hit.hpp"

#include <cmath>
#include <fmt/format.h>
#include <memory>

namespace levelray {

namespace {

bool same(const Hit& a, const Hit& b, double scale = 1) {
  return a.status == b.status && a.t * scale == b.t && a.t_outside * scale == b.t_outside &&
         a.cell == b.cell && a.from_inside == b.from_inside;
}

std::vector<WorldRay> some_rays(RayTrial& trial, int count) {
  std::vector<WorldRay> rays;
  for (int i = 0; i < count; ++i) {
    WorldRay ray = trial.random_ray();
    if (i % 5 == 0) ray.origin = trial.random_place();
    if (i % 7 == 0) ray.t_max = trial.uniform(0, 60) * trial.grid().transform.voxel_size;
    if (i % 9 == 0) ray.direction = Vec3d(i % 2 ? 1 : 0, -1, i % 4 ? 1 : 0);
    rays.push_back(ray);
  }
  return rays;
}

// Every intersector by every traversal, with and without bounds, and any hit by every scheme.
ExtremeOutcome accelerations(const ExtremeSettings& settings) {
  ExtremeTally tally;
  for (const NamedGrid& each : study_grids()) {
    RayTrial trial(each.grid, each.name, settings, tally);
    const LevelSet& level_set = trial.level_set();
    const std::vector<WorldRay> rays = some_rays(trial, 1500);
    const Occluders occluders(each.grid, level_set.surface());
    // A camera's rays, for min/max buffers of several sizes.
    const Camera camera(framing_camera(Box3d(Vec3d(-9, -9, -9), Vec3d(9, 9, 9)), 48, 48));
    const std::vector<WorldRay> primary = primary_rays(camera);
    PinholeView view{camera.settings().eye, camera.right(), camera.up(), camera.forward()};
    view.half_width = view.half_height = camera.half_height();
    for (const std::string& intersector : method_names<Intersectors>()) {
      PrimaryOptions options;
      options.intersector = intersector;
      std::vector<Hit> expected(rays.size()), hits(rays.size()), expected_primary(primary.size()),
          primary_hits(primary.size());
      closest_hits(level_set, rays, options, expected);
      closest_hits(level_set, primary, options, expected_primary);
      const auto compare = [&](const std::vector<Hit>& a, const std::vector<Hit>& b,
                               const std::vector<WorldRay>& with, const std::string& what) {
        for (std::size_t i = 0; i < a.size(); ++i) {
          tally.add();
          tally.check(same(a[i], b[i]), [&] {
            return trial.describe(with[i]) + ": " + intersector + ": another hit with " + what;
          });
        }
      };
      for (std::size_t t = 0; t < traversal_names().size(); ++t) {
        options.traversal = static_cast<Traversal>(t), options.bounds = {};
        closest_hits(level_set, rays, options, hits);
        compare(expected, hits, rays, traversal_names()[t]);
        for (const int size : {1, 7, 64}) {
          const MinMaxBuffer buffer(level_set.surface(), each.grid.transform, view, size);
          std::vector<RayBounds> bounds;
          for (const auto& [x, y] : tiled_pixels(48)) bounds.push_back(buffer.at(x / 48, y / 48));
          options.bounds = bounds;
          closest_hits(level_set, primary, options, primary_hits);
          compare(expected_primary, primary_hits, primary,
                  traversal_names()[t] + fmt::format(" and a {}^2 min/max buffer", size));
        }
        for (std::size_t scheme = 0; scheme < shadow_scheme_names().size(); ++scheme) {
          ShadowOptions shadow;
          shadow.intersector = intersector, shadow.traversal = options.traversal;
          shadow.scheme = static_cast<ShadowScheme>(scheme), shadow.occluders = &occluders;
          const auto any = std::make_unique<bool[]>(rays.size());
          any_hits(level_set, rays, shadow, {any.get(), rays.size()}, {});
          for (std::size_t i = 0; i < rays.size(); ++i) {
            tally.add();
            tally.check(any[i] == bool(expected[i]), [&] {
              return trial.describe(rays[i]) + ": " + intersector + ": another answer with shadows by " +
                     shadow_scheme_names()[scheme];
            });
          }
        }
      }
    }
  }
  return tally.outcome();
}

ExtremeOutcome powers_of_two(const ExtremeSettings& settings) {
  ExtremeTally tally;
  for (const NamedGrid& each : study_grids()) {
    RayTrial trial(each.grid, each.name, settings, tally);
    const std::vector<WorldRay> rays = some_rays(trial, 600);
    for (const double scale : {0x1p-60, 0x1p-20, 0x1p1, 0x1p40, 0x1p80}) {
      BlockGrid grid = each.grid;
      grid.transform.voxel_size *= scale;
      grid.background *= static_cast<float>(scale);
      for (float& value : grid.values) value *= static_cast<float>(scale);
      const LevelSet level_set(grid);
      for (const WorldRay& ray : rays) {
        WorldRay scaled = ray, longer = ray;
        scaled.origin *= scale, scaled.t_max *= scale;
        longer.direction *= scale, longer.t_max /= scale;
        const Hit here = closest_hit(trial.level_set(), ray), there = closest_hit(level_set, scaled);
        const CertifiedHit a = certify(trial.level_set(), ray, here), b = certify(level_set, scaled, there);
        tally.add();
        tally.check(
            same(here, there, scale) && a.proof == b.proof &&
                (!here ||
                 (a.t_lo * scale == b.t_lo && a.t_hi * scale == b.t_hi && a.error * scale == b.error)),
            [&] {
              return trial.describe(ray) +
                     fmt::format(": another hit, or another proof, when all is scaled by {:a}", scale);
            });
        tally.check(same(here, closest_hit(trial.level_set(), longer), 1 / scale), [&] {
          return trial.describe(ray) +
                 fmt::format(": another hit when the direction is scaled by {:a}", scale);
        });
      }
    }
  }
  return tally.outcome();
}

// The same lattice elsewhere, or seen from another side, and rays likewise: the places of both are certified,
// so they may differ by the sum of their bounds, and by nothing else but where both are grazes.
void compare_moved(RayTrial& trial, const LevelSet& level_set, const WorldRay& ray, const WorldRay& moved,
                   const std::string& how, ExtremeTally& tally) {
  const Hit here = closest_hit(trial.level_set(), ray), there = closest_hit(level_set, moved);
  tally.add();
  const CertifiedHit a = certify(trial.level_set(), ray, here), b = certify(level_set, moved, there);
  const bool graze = a.proof == Proof::graze || b.proof == Proof::graze || a.proof == Proof::beginning ||
                     b.proof == Proof::beginning;
  const bool unsure = (!here && a.clear_to < ray.t_max) || (!there && b.clear_to < moved.t_max);
  if (graze || unsure) return;
  tally.check(bool(here) == bool(there),
              [&] { return trial.describe(ray) + ": hit or miss changes when " + how; });
  if (!here || !there) return;
  const double off = std::fabs(here.t - there.t);
  tally.error(off / trial.grid().transform.voxel_size);
  tally.check(off <= a.error + b.error, [&] {
    return trial.describe(ray) + fmt::format(": hit {:a} is {:a} when {}; certified are {:.3g} and {:.3g}",
                                             here.t, there.t, how, a.error, b.error);
  });
}

ExtremeOutcome symmetries(const ExtremeSettings& settings) {
  ExtremeTally tally("voxel");
  for (const NamedGrid& each : study_grids()) {
    RayTrial trial(each.grid, each.name, settings, tally);
    const std::vector<WorldRay> rays = some_rays(trial, 250);
    const int orders[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
    for (const auto& order : orders)
      for (int signs = 0; signs < 8; ++signs) {
        LatticeSymmetry symmetry;
        for (int a = 0; a < 3; ++a) symmetry.order[a] = order[a], symmetry.sign[a] = signs >> a & 1 ? -1 : 1;
        const BlockGrid grid = moved_grid(each.grid, symmetry);
        const LevelSet level_set(grid);
        for (const WorldRay& ray : rays) {
          WorldRay moved = ray;
          moved.origin = symmetry.moved(ray.origin), moved.direction = symmetry.moved(ray.direction);
          compare_moved(trial, level_set, ray, moved,
                        fmt::format("axes are {}{}{} with signs {}", order[0], order[1], order[2], signs),
                        tally);
        }
      }
  }
  return tally.outcome();
}

ExtremeOutcome translations(const ExtremeSettings& settings) {
  ExtremeTally tally("voxel");
  for (const NamedGrid& each : study_grids()) {
    RayTrial trial(each.grid, each.name, settings, tally);
    std::vector<WorldRay> rays = some_rays(trial, 300);
    // On a lattice of 2^-20, so that moved origins are exact.
    for (WorldRay& ray : rays)
      for (int a = 0; a < 3; ++a) ray.origin[a] = std::ldexp(std::round(std::ldexp(ray.origin[a], 20)), -20);
    for (const int k : {0, 1, 4, 7, 12, 20, 26})
      for (const int sign : {1, -1}) {
        const int by = sign * (1 << k);
        const Vec3i low = each.grid.node_min * node_dim, size = each.grid.node_dims * node_dim,
                    shift(by, -by, by / 2);
        const BlockGrid grid = grid_of_samples(
            low + shift, size,
            [&](int i, int j, int k_) { return each.grid.value(i - shift.x, j - shift.y, k_ - shift.z); },
            each.grid.background);
        const LevelSet level_set(grid);
        for (const WorldRay& ray : rays) {
          WorldRay moved = ray;
          moved.origin += Vec3d(shift);
          compare_moved(trial, level_set, ray, moved,
                        fmt::format("all moves by ({}, {}, {}) samples", shift.x, shift.y, shift.z), tally);
        }
      }
  }
  return tally.outcome();
}

// A closed room: no light from outside reaches its inside, whatever its walls are like.
ExtremeOutcome furnace(const ExtremeSettings& settings) {
  ExtremeTally tally;
  const Vec3d w = Vec3d(0.42, 0.31, 0.85).normalized();
  const struct {
    const char* name;
    Vec3d axis;
    double wall;
  } rooms[] = {{"room along the axes, walls of 2 voxels", Vec3d(0, 0, 1), 2},
               {"room along the axes, walls of 1 voxel", Vec3d(0, 0, 1), 1},
               {"turned room, walls of 2 voxels", w, 2}};
  for (const auto& room : rooms) {
    const BlockGrid grid = grid_of_field(
        [&](const Vec3d& p) { return std::fabs(box_distance(p, Vec3d(7, 6, 5), room.axis)) - room.wall / 2; },
        13);
    RayTrial trial(grid, room.name, settings, tally);
    const LevelSet& level_set = trial.level_set();
    const Occluders occluders(grid, level_set.surface());
    for (int i = 0; i < 12000; ++i) {
      WorldRay ray;
      do ray.origin = trial.random_place();
      while (!(box_distance(ray.origin, Vec3d(7, 6, 5), room.axis) < -room.wall / 2 - 0.5));
      ray.direction = trial.random_direction();
      if (i % 3 == 0) { // to vertices of the lattice in the walls, its edges and corners
        Vec3d target = trial.surface()[static_cast<std::size_t>(i / 3) % trial.surface().size()];
        for (int a = 0; a < 3; ++a)
          if (i % 5 > a) target[a] = std::round(target[a]);
        ray.direction = target - ray.origin;
      }
      if (i % 4 == 0)
        for (int a = 0; a < 3; ++a) ray.origin[a] = std::round(ray.origin[a]);
      if (i % 11 == 0) ray.direction = Vec3d(i % 2 ? 1 : -1, i % 4 < 2 ? 1 : 0, i % 8 < 4 ? -1 : 0);
      if (!(box_distance(ray.origin, Vec3d(7, 6, 5), room.axis) < -room.wall / 2 - 0.5)) continue;
      tally.add();
      tally.check(any_hit(level_set, ray) && closest_hit(level_set, ray),
                  [&] { return trial.describe(ray) + ": light leaks in"; });
      // From where the ray arrives the room is as closed: secondary rays begin at t_outside.
      const Hit hit = closest_hit(level_set, ray);
      WorldRay next;
      next.origin = ray.at(hit.t_outside), next.direction = trial.random_direction();
      tally.check(!hit || any_hit(level_set, next),
                  [&] { return trial.describe(next) + ": light leaks in after a bounce"; });
    }
  }
  return tally.outcome();
}

ExtremeOutcome reciprocity(const ExtremeSettings& settings) {
  ExtremeTally tally;
  for (const NamedGrid& each : study_grids()) {
    RayTrial trial(each.grid, each.name, settings, tally);
    for (int i = 0; i < 4000; ++i) {
      WorldRay there, back;
      const Vec3d a = trial.random_place(), b = trial.random_place();
      there.origin = a, there.direction = b - a, there.t_max = 1;
      back.origin = b, back.direction = a - b, back.t_max = 1;
      tally.add();
      if (any_hit(trial.level_set(), there) == any_hit(trial.level_set(), back)) continue;
      // One of them is in doubt: f comes within rounding of 0.
      const RayAnswer one = trial.judge().ask(there), other = trial.judge().ask(back);
      const bool doubt = !(one.latest < 2) && !(other.latest < 2);
      tally.check(doubt, [&] { return trial.describe(there) + ": seen one way only"; });
    }
  }
  return tally.outcome();
}

ExtremeOutcome brackets(const ExtremeSettings& settings) {
  ExtremeTally tally("voxel");
  for (const NamedGrid& each : study_grids()) {
    RayTrial trial(each.grid, each.name, settings, tally);
    for (int i = 0; i < 1500; ++i) trial.judge(trial.random_ray());
    trial.judge_all_kinds(250);
  }
  return tally.outcome();
}

} // namespace

std::vector<ExtremeRow> extreme_invariant_rows() {
  return {
      {"invariants", "brackets-and-parity",
       "f(t_lo) > 0 >= f(t_hi) in exact numbers, |t - first root| within the bound, parity of crossings the "
       "change of sign, any hit where there is a closest.",
       brackets},
      {"invariants", "accelerations",
       "Leaps, min/max buffers of 1, 7 and 64 cells, and shadow schemes change no bit of any intersector's "
       "hits.",
       accelerations},
      {"invariants", "powers-of-two",
       "Scales from 2^-60 to 2^80, of everything and of directions, change no bit but the exponents.",
       powers_of_two},
      {"invariants", "symmetries",
       "All 48 permutations and reflections of axes: the same hits, within the certified bounds.",
       symmetries},
      {"invariants", "translations",
       "Moved by 2^0 to 2^26 samples either way: the same hits, within the certified bounds.", translations},
      {"invariants", "furnace", "No ray leaves a closed room, and none does after a bounce.", furnace},
      {"invariants", "reciprocity", "A sees B exactly when B sees A, but where f is within rounding of 0.",
       reciprocity},
  };
}

} // namespace levelray
