// Grids of the suite `extremes`: sizes, places, bands, and values that are no distances.
#include "levelray/convert/field_to_grid.hpp"
#include "levelray/measure/extremes.hpp"
#include "levelray/measure/made_grids.hpp"
#include "levelray/measure/ray_trial.hpp"

#include <cmath>
#include <fmt/format.h>

namespace levelray {

namespace {

// Uniform in [-1, 1), a function of the sample and a salt.
double noise(int i, int j, int k, std::uint64_t salt) {
  std::uint64_t x = salt * 0x9E3779B97F4A7C15u;
  for (const int a : {i, j, k}) {
    x ^= static_cast<std::uint64_t>(a + 0x100000) * 0x9E3779B97F4A7C15u;
    x ^= x >> 29, x *= 0xBF58476D1CE4E5B9u, x ^= x >> 32;
  }
  return static_cast<double>(x >> 11) * 0x1p-52 - 1;
}

using MakeGrids = std::function<std::vector<NamedGrid>()>;

// A row that judges rays of all kinds through each grid.
ExtremeRow judged(const char* name, const char* expected, MakeGrids grids, std::size_t rays = 25) {
  return {"grids", name, expected, [=](const ExtremeSettings& settings) {
            ExtremeTally tally("voxel");
            for (const NamedGrid& each : grids()) {
              RayTrial trial(each.grid, each.name, settings, tally, 1, 100);
              trial.judge_all_kinds(rays);
            }
            return tally.outcome();
          }};
}

std::string size_text(const Vec3i& size) {
  return fmt::format("{} x {} x {} samples", size.x, size.y, size.z);
}

// Full of -1, and full of noise, from places beside and on the borders of blocks and nodes.
std::vector<NamedGrid> of_size(const Vec3i& size) {
  std::vector<NamedGrid> grids;
  for (const int at : {0, -3, 1}) {
    const Vec3i low(at, 2 * at, -at);
    const std::string text = size_text(size) + fmt::format(" from ({}, {}, {})", low.x, low.y, low.z);
    grids.push_back({text + ", all inside", grid_of_samples(
                                                low, size, [](int, int, int) { return -1.f; }, 3)});
    if (size.x * size.y * size.z > 10000) break;
    grids.push_back(
        {text + ", noise",
         grid_of_samples(
             low, size, [](int i, int j, int k) { return static_cast<float>(noise(i, j, k, 7)); }, 3)});
  }
  return grids;
}

std::vector<NamedGrid> of_sizes(const std::vector<Vec3i>& sizes) {
  std::vector<NamedGrid> grids;
  for (const Vec3i& size : sizes)
    for (NamedGrid& grid : of_size(size)) grids.push_back(std::move(grid));
  return grids;
}

ExtremeOutcome empty(const ExtremeSettings& settings) {
  ExtremeTally tally;
  const NamedGrid grids[] = {
      {"a grid without nodes", BlockGrid{}},
      {"a grid without inside", grid_of_samples(
                                    Vec3i(-3, 0, 2), Vec3i(9, 8, 7), [](int, int, int) { return 1.f; }, 3)}};
  for (const NamedGrid& each : grids) {
    BlockGrid grid = each.grid;
    if (grid.background == 0) grid.background = 3;
    RayTrial trial(grid, each.name, settings, tally, 1, 10);
    for (int i = 0; i < 40; ++i) {
      WorldRay ray = trial.random_ray();
      if (i % 3 == 0) ray.origin = Vec3d(0, 0, 0);
      trial.judge_nothing(ray);
    }
  }
  return tally.outcome();
}

// Samples whose last layer is inside, at the last sample of a block, of a node, and the first of the next.
std::vector<NamedGrid> at_boundary() {
  std::vector<NamedGrid> grids;
  for (const int end : {3, 4, 15, 16, 17})
    for (const int sign : {1, -1}) {
      const int low = sign > 0 ? end - 9 : -end, size = 10;
      grids.push_back({fmt::format("ball cut off at sample {}", sign * end),
                       grid_of_samples(
                           Vec3i(low, low, low), Vec3i(size, size, size),
                           [=](int i, int j, int k) {
                             return static_cast<float>(
                                 ball_distance(Vec3d(i, j, k), Vec3d(1, 1, 1) * (sign * end), 6.2));
                           },
                           16)});
    }
  return grids;
}

std::vector<NamedGrid> with_transforms(std::initializer_list<GridTransform> transforms) {
  std::vector<NamedGrid> grids;
  for (const GridTransform& transform : transforms)
    for (NamedGrid& grid : study_grids(transform)) {
      grid.name += fmt::format(", voxel {:a}, origin ({:a}, {:a}, {:a})", transform.voxel_size,
                               transform.origin.x, transform.origin.y, transform.origin.z);
      grids.push_back(std::move(grid));
    }
  return grids;
}

std::vector<NamedGrid> one_voxel_band() {
  const Vec3d tilt = Vec3d(0.42, 0.31, 0.85).normalized();
  return {
      {"ball, band 1",
       grid_of_field([](const Vec3d& p) { return ball_distance(p, Vec3d(0.2, -0.1, 0.4), 7.4); }, 9, {}, 1)},
      {"plate, band 1",
       grid_of_field([=](const Vec3d& p) { return box_distance(p, Vec3d(9, 9, 0.6), tilt); }, 15, {}, 1)},
      {"box, band 1",
       grid_of_field([](const Vec3d& p) { return box_distance(p, Vec3d(5, 4, 3.5)); }, 7, {}, 1)},
      {"torus, band 1.2",
       grid_of_field([=](const Vec3d& p) { return torus_distance(p, 8, 2, tilt); }, 11, {}, 1.2)}};
}

// A torus' values made no distances in several ways. All samples are active, and nothing is clamped.
std::vector<NamedGrid> no_distances() {
  const Vec3d tilt = Vec3d(0.42, 0.31, 0.85).normalized();
  const struct {
    const char* name;
    std::function<double(double, int, int, int)> change;
    float background;
  } ways[] = {{"scaled by 1e-3", [](double d, int, int, int) { return d * 1e-3; }, 1},
              {"scaled by 1e3", [](double d, int, int, int) { return d * 1e3; }, 1e5f},
              {"with a gradient of 10", [](double d, int, int, int) { return 10 * d; }, 1e3f},
              {"cubed", [](double d, int, int, int) { return d * d * d; }, 1e5f},
              {"steps", [](double d, int, int, int) { return d < 0 ? -1.0 : 1; }, 3},
              {"with noise", [](double d, int i, int j, int k) { return d + 0.8 * noise(i, j, k, 3); }, 100},
              {"whole numbers", [](double d, int, int, int) { return std::floor(d + 0.5); }, 100},
              {"noise of whole numbers",
               [](double, int i, int j, int k) { return std::floor(1.5 * noise(i, j, k, 5) + 0.5); }, 2},
              {"noise alone", [](double, int i, int j, int k) { return noise(i, j, k, 9); }, 2}};
  std::vector<NamedGrid> grids;
  for (const auto& way : ways)
    grids.push_back({std::string("torus, ") + way.name,
                     grid_of_samples(
                         Vec3i(-10, -10, -10), Vec3i(21, 21, 21),
                         [&](int i, int j, int k) {
                           return static_cast<float>(
                               way.change(torus_distance(Vec3d(i, j, k), 6, 2, tilt), i, j, k));
                         },
                         way.background)});
  return grids;
}

// Two balls at opposite corners of more samples than 32 bits can count: 1312^3 > 2^31, and 1640^3 > 2^32.
ExtremeOutcome many_samples(const ExtremeSettings& settings) {
  ExtremeTally tally("voxel");
  for (const int size : {1312, 1640}) {
    const Vec3d corner = Vec3d(0.5, 0.5, 0.5) * (size - 30.0);
    const BlockGrid grid = grid_of_field(
        [=](const Vec3d& p) {
          return std::min(ball_distance(p, corner, 6.3), ball_distance(p, -corner, 5.6));
        },
        corner + Vec3d(8, 8, 8));
    const double samples = 4096.0 * grid.node_dims.x * grid.node_dims.y * grid.node_dims.z;
    tally.check(samples > (size > 1400 ? 0x1p32 : 0x1p31),
                [&] { return fmt::format("only {} samples", samples); });
    RayTrial trial(grid, fmt::format("two balls in {}^3 samples", size), settings, tally, 1, 0);
    const auto near = [&](double side) {
      return corner * side + Vec3d(trial.uniform(-5, 5), trial.uniform(-5, 5), trial.uniform(-5, 5));
    };
    for (int i = 0; i < 60; ++i) { // from ball to ball, and from far off at one of them
      WorldRay ray;
      ray.origin = near(i % 2 ? 1 : -1), ray.direction = near(i % 2 ? -1 : 1) - ray.origin;
      if (i % 3) ray.t_min = -3;
      trial.judge(ray);
      ray.direction = trial.random_direction(), ray.t_min = 0;
      ray.origin -= ray.direction * 3000;
      trial.judge(ray);
    }
  }
  return tally.outcome();
}

std::vector<NamedGrid> far_indices() {
  std::vector<NamedGrid> grids;
  for (const int at : {1 << 20, -(1 << 24) - 5, 400'000'000, -400'000'003}) {
    const Vec3i low(at, -at, at / 2);
    grids.push_back({fmt::format("ball at sample {}", at),
                     grid_of_samples(
                         low, Vec3i(12, 12, 12),
                         [=](int i, int j, int k) {
                           const Vec3d p = Vec3d(Vec3i(i, j, k) - low);
                           return static_cast<float>(ball_distance(p, Vec3d(5.3, 5.6, 5.9), 3.7));
                         },
                         8)});
  }
  return grids;
}

ExtremeOutcome indices_refused(const ExtremeSettings&) {
  return expect_refusal("indices beyond 2^30", [] {
    GridTransform transform;
    transform.voxel_size = 1e-9;
    grid_of_field([](const Vec3d& p) { return ball_distance(p, Vec3d(2e9, 0, 0), 5); }, Vec3d(2e9 + 5, 5, 5),
                  transform);
  });
}

ExtremeOutcome table_refused(const ExtremeSettings&) {
  return expect_refusal("table of nodes needs more memory than allowed", [] {
    FieldSampling sampling;
    sampling.voxel_size = 1e-6, sampling.max_bytes = std::uint64_t{1} << 30;
    FieldBand(sampling, Box3d(Vec3d(-1, -1, -1), Vec3d(1, 1, 1)));
  });
}

ExtremeOutcome masks_refused(const ExtremeSettings&) {
  return expect_refusal("the grid has no cell masks", [] {
    BlockGrid grid = study_grids()[0].grid;
    grid.cells.clear();
    const LevelSet level_set(grid);
  });
}

} // namespace

std::vector<ExtremeRow> extreme_grid_rows() {
  return {
      judged(
          "one-sample", "A single sample inside.", [] { return of_size(Vec3i(1, 1, 1)); }, 60),
      judged("one-block", "Exactly one block of 4 x 4 x 4 samples.", [] { return of_size(Vec3i(4, 4, 4)); }),
      judged(
          "sizes", "2, 7, 8, 9, 64 and 65 samples a side, all inside and noise.",
          [] {
            std::vector<Vec3i> sizes;
            for (const int n : {2, 7, 8, 9, 64, 65}) sizes.emplace_back(n, n, n);
            return of_sizes(sizes);
          },
          12),
      judged("not-cubic", "1 x 1 x 70, 65 x 2 x 9 and 3 x 64 x 17 samples.",
             [] {
               return of_sizes({Vec3i(1, 1, 70), Vec3i(65, 2, 9), Vec3i(3, 64, 17)});
             }),
      {"grids", "empty", "Grids without samples, or without inside, are missed by all rays.", empty},
      judged("surface-at-boundary",
             "Surfaces that end with the samples, at the last sample of blocks and nodes.", at_boundary),
      judged("voxels-1e-9", "Voxels of 1e-9 and 1e-25.",
             [] {
               return with_transforms({{Vec3d(0, 0, 0), 1e-9}, {Vec3d(1e-23, 0, -1e-22), 1e-25}});
             }),
      judged("voxels-1e9", "Voxels of 1e9 and 1e25.",
             [] {
               return with_transforms({{Vec3d(0, 0, 0), 1e9}, {Vec3d(1e10, 0, -1e10), 1e25}});
             }),
      judged("offset-1e7",
             "World offsets of 1e7, as in UTM coordinates, with voxels of 1 m, 1 cm and 0.1 mm.",
             [] {
               const Vec3d utm(1e7 / 2 + 0.37, 1e7 - 0.11, 812.3);
               return with_transforms({{utm, 1}, {utm, 0.01}, {utm, 1e-4}});
             }),
      judged("band-1-voxel", "Bands of 1 voxel.", one_voxel_band),
      judged("no-distances",
             "Values scaled by 1e-3 and 1e3, of gradient 10, cubed, stepped, and noise: exact for the "
             "interpolant.",
             no_distances),
      {"grids", "samples-2^31",
       "1312^3 and 1640^3 samples, more than 31 and 32 bits count, of which few are stored.", many_samples},
      judged("far-indices", "Samples with indices up to 4e8, far from the lattice's origin.", far_indices),
      {"grids", "indices-2^30", "Fields whose samples have indices beyond 2^30 are refused.",
       indices_refused},
      {"grids", "table-too-large",
       "Tables of nodes larger than the memory allowed are refused before it is taken.", table_refused},
      {"grids", "no-masks", "Grids whose cell masks are out of date are refused.", masks_refused},
  };
}

} // namespace levelray
