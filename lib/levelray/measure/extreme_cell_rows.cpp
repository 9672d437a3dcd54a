// Cells of the suite `extremes`: eight corners, whatever they are.
#include "levelray/intersect/exact.hpp"
#include "levelray/measure/extremes.hpp"
#include "levelray/measure/made_grids.hpp"
#include "levelray/measure/ray_trial.hpp"

#include <array>
#include <cfloat>
#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace levelray {

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
using Corners = std::array<float, 8>; // x + 2y + 4z

// What lies around the cell: the outside, or its own corners going on for three samples.
enum class Around { outside, itself };

// The cell at `at`, with a margin of three samples.
BlockGrid cell_grid(const Corners& f, const Vec3i& at, Around around) {
  float largest = 0;
  for (const float v : f) largest = std::max(largest, std::fabs(v));
  const float background = largest > 0 ? std::min(4 * largest, FLT_MAX) : 1; // no other size comes in
  return grid_of_samples(
      at - Vec3i(3, 3, 3), Vec3i(8, 8, 8),
      [&](int i, int j, int k) {
        const Vec3i q = Vec3i(i, j, k) - at;
        const auto digit = [](int x) { return std::clamp(x, 0, 1); };
        const bool corner = q == Vec3i(digit(q.x), digit(q.y), digit(q.z));
        if (!corner && around == Around::outside) return background;
        return f[static_cast<std::size_t>(digit(q.x) + 2 * digit(q.y) + 4 * digit(q.z))];
      },
      background);
}

std::string corners_text(const Corners& f) {
  std::string text = "corners";
  for (const float v : f) text += fmt::format(" {:a}", v);
  return text;
}

// Within a block, across blocks, across nodes, at negative indices.
const Vec3i places[] = {{1, 1, 2}, {3, 3, 3}, {15, 15, 15}, {-1, -17, -5}};

// Judges rays of all kinds at each of the cells.
ExtremeRow judged(const char* name, const char* expected, std::function<std::vector<Corners>()> cells,
                  std::size_t rays = 12, bool wild = false) {
  return {"cells", name, expected, [=](const ExtremeSettings& settings) {
            ExtremeTally tally("voxel");
            for (const Corners& f : cells())
              for (const Vec3i& at : places)
                for (const Around around : {Around::outside, Around::itself}) {
                  const BlockGrid grid = cell_grid(f, at, around);
                  RayTrial trial(grid,
                                 fmt::format("{} at ({}, {}, {}){}", corners_text(f), at.x, at.y, at.z,
                                             around == Around::itself ? ", going on" : ""),
                                 settings, tally, 1, 40);
                  if (wild) trial.without_safe_places();
                  trial.judge_all_kinds(rays);
                }
            return tally.outcome();
          }};
}

Corners constant(float value) {
  Corners f;
  f.fill(value);
  return f;
}

// Every choice of some of -1, 0, 1 at the corners.
ExtremeOutcome all_signs(const ExtremeSettings& settings) {
  ExtremeTally tally("voxel");
  for (int n = 0; n < 6561; ++n) {
    Corners f;
    for (int c = 0, rest = n; c < 8; ++c, rest /= 3)
      f[static_cast<std::size_t>(c)] = static_cast<float>(rest % 3 - 1);
    const BlockGrid grid = cell_grid(f, places[n % 4], n % 8 < 4 ? Around::outside : Around::itself);
    ExtremeSettings own = settings;
    own.seed += static_cast<std::uint64_t>(n);
    RayTrial trial(grid, corners_text(f) + fmt::format(" at place {}", n % 4), own, tally, 1, 6);
    trial.judge_all_kinds(1);
  }
  return tally.outcome();
}

// Through a cell along its diagonal (1,1,0), half way up, or (1,1,1), on which the cubic has these Bernstein
// coefficients, three or four: the fraction of the diagonal at which it is hit, or NaN.
double diagonal_hit(const std::vector<float>& b, const ExtremeSettings& settings) {
  const bool cubic = b.size() == 4;
  const Corners f = cubic ? Corners{b[0], b[1], b[1], b[2], b[1], b[2], b[2], b[3]}
                          : Corners{b[0], b[1], b[1], b[2], b[0], b[1], b[1], b[2]};
  const BlockGrid grid = cell_grid(f, Vec3i(0, 0, 0), Around::outside);
  const LevelSet level_set(grid);
  WorldRay ray;
  ray.direction = Vec3d(1, 1, cubic ? 1 : 0);
  ray.origin = Vec3d(0, 0, cubic ? 0 : 0.5);
  ray.t_max = 1; // the diagonal, exactly
  const Hit hit = closest_hit(level_set, ray, settings.intersector);
  return hit ? hit.t : std::numeric_limits<double>::quiet_NaN();
}

std::string bernstein_text(const std::vector<float>& b) {
  std::string text = "Bernstein coefficients along the diagonal";
  for (const float v : b) text += fmt::format(" {:a}", v);
  return text;
}

// (1 - 2s)^2 + c: roots (1 -+ sqrt(-c)) / 2, all corners and so all arithmetic exact. c in units of the last
// place of the corners.
ExtremeOutcome double_root(const ExtremeSettings& settings) {
  ExtremeTally tally("voxel");
  for (int ulps = -64; ulps <= 64; ++ulps) {
    const float c = static_cast<float>(ulps) * 0x1p-23f;
    const std::vector<float> b{1 + c, -1 + c, 1 + c};
    const double s = diagonal_hit(b, settings);
    tally.add();
    const auto text = [&] { return bernstein_text(b) + fmt::format(": hit at {:a}", s); };
    if (!tally.check(std::isnan(s) == (ulps > 0), text) || ulps > 0) continue;
    const double expected = (1 - std::sqrt(-double{c})) / 2;
    tally.error(std::fabs(s - expected) * std::sqrt(2.0));
    // Values are off by 2^-49 at most (bernstein.hpp), the slope at the root is 4 sqrt(-c) or, for the double
    // root itself, f rises as 4 ds^2.
    const double off = ulps ? 0x1p-49 / (4 * std::sqrt(-double{c})) + 0x1p-38 : 0x1p-25;
    tally.check(std::fabs(s - expected) <= off, text);
  }
  return tally.outcome();
}

// ((1-s) - s)^3 and what is near it: b = 1, -1, 1, -1 with the middle ones moved.
ExtremeOutcome triple_root(const ExtremeSettings& settings) {
  ExtremeTally tally("voxel");
  for (int ulps = -40; ulps <= 40; ++ulps) {
    // f = (1-2s)^3 + 3 e s (1-s): at the middle 3 e / 4.
    const float e = static_cast<float>(ulps) * 0x1p-23f;
    const std::vector<float> b{1, -1 + e, 1 + e, -1};
    const double s = diagonal_hit(b, settings);
    tally.add();
    // One root, as the slope is -6 (1-2s)^2 + 3 e (1-2s), of which the second part never wins by enough to
    // bring f back to 0: bisection in long double.
    long double low = 0, high = 1;
    for (int i = 0; i < 64; ++i) {
      const long double m = (low + high) / 2, x = 1 - 2 * m;
      (x * x * x + 3 * static_cast<long double>(e) * m * (1 - m) > 0 ? low : high) = m;
    }
    const double expected = static_cast<double>(high);
    tally.error(std::fabs(s - expected) * std::sqrt(3.0));
    // An error of 2^-49 in f = 8 ds^3 moves the triple root by 2^-17.3.
    tally.check(std::fabs(s - expected) <= 0x1p-17,
                [&] { return bernstein_text(b) + fmt::format(": hit at {:a}, right is {:a}", s, expected); });
  }
  return tally.outcome();
}

// (s - r)(s - r - gap): the floats are rounded, so the roots are those of their own quadratic.
ExtremeOutcome close_roots(const ExtremeSettings& settings) {
  ExtremeTally tally("voxel");
  for (const double gap : {1e-7, 1e-6, 1e-9, 1e-12})
    for (const double r : {gap, 3 * gap, 100 * gap, 0.0})
      for (const double scale : {1.0, 1e-6, 1e6}) {
        const long double q = r + gap;
        const std::vector<float> b{static_cast<float>(scale * (r * q)),
                                   static_cast<float>(scale * (r * q - (r + q) / 2)),
                                   static_cast<float>(scale * ((1 - r) * (1 - q)))};
        const long double A = static_cast<long double>(b[0]) - 2 * static_cast<long double>(b[1]) + b[2],
                          B = static_cast<long double>(b[1]) - b[0], C = b[0];
        const long double D = B * B - A * C;
        const double s = diagonal_hit(b, settings);
        tally.add();
        const auto text = [&] { return bernstein_text(b) + fmt::format(": hit at {:a}", s); };
        if (!tally.check((D >= 0) == !std::isnan(s), text) || D < 0) continue;
        const long double expected =
            C == 0 ? 0 : C / (std::sqrt(D) - B); // the smaller one, without cancellation
        tally.error(std::fabs(s - static_cast<double>(expected)) * std::sqrt(2.0));
        // Values are off by 2^-49 of the largest corner, about `scale`; the slope at the root is 2 sqrt(D).
        tally.check(std::fabs(s - expected) <= 0x1p-49L * scale / (2 * std::sqrt(D)) + 0x1p-38L, text);
      }
  return tally.outcome();
}

// b0 = 0, or b3 = 0, or both: closed intervals, exact numbers.
ExtremeOutcome roots_at_ends(const ExtremeSettings& settings) {
  ExtremeTally tally("voxel");
  // Values are off by 2^-49 of the largest coefficient, which moves a double root to its square root, a
  // triple one to its cube root.
  const double simple = 0x1p-40, twice = 0x1p-23, thrice = 0x1p-15;
  const struct {
    std::vector<float> b;
    double expected, off;
  } cases[] = {{{0, 1, 2}, 0, simple},       {{0, -1, -2}, 0, simple},  {{2, 1, 0}, 1, simple},
               {{0, 0, 0}, 0, simple},       {{0, 1, 0}, 0, simple},    {{1, 1, 0, 0}, 1, twice},
               {{0, 0, 1, 1}, 0, simple},    {{1, 0, 0}, 1, twice},     {{4, 0, 0, 0}, 1, thrice},
               {{0, 1, -1, 0}, 0, simple},   {{2, -1, 0}, 0.5, simple}, {{1, 0, 0, -1}, 0.5, simple},
               {{1, 0, 1}, infinite, simple}};
  for (const auto& c : cases) {
    const double s = diagonal_hit(c.b, settings);
    tally.add();
    const bool right = std::isnan(s) ? c.expected == infinite : std::fabs(s - c.expected) <= c.off;
    if (!std::isnan(s) && c.expected < infinite) tally.error(std::fabs(s - c.expected));
    tally.check(right, [&] {
      return bernstein_text(c.b) + fmt::format(": hit at {:a}, right is {:a}", s, c.expected);
    });
  }
  return tally.outcome();
}

std::vector<Corners> of_sizes(std::initializer_list<float> sizes, std::uint64_t salt) {
  std::vector<Corners> cells;
  std::mt19937_64 random(salt);
  const std::vector<float> all(sizes);
  for (int n = 0; n < 24; ++n) {
    Corners f;
    for (float& v : f) {
      v = all[random() % all.size()] *
          static_cast<float>(0.25 + 0.75 * static_cast<double>(random() >> 11) * 0x1p-53);
      if (random() % 2) v = -v;
    }
    cells.push_back(f);
  }
  return cells;
}

std::vector<Corners> planes(bool tilted) {
  std::vector<Corners> cells;
  for (int n = 0; n < 12; ++n) {
    Corners f;
    const int normal[3] = {n % 3 == 0 || tilted, n % 3 == 1 || (tilted && n % 2), n % 3 == 2};
    for (int c = 0; c < 8; ++c)
      f[static_cast<std::size_t>(c)] =
          static_cast<float>(2 * (normal[0] * (c & 1) + normal[1] * (c >> 1 & 1) + normal[2] * (c >> 2)) - 1 +
                             (n / 4 - 1) * 0.25);
    cells.push_back(f);
  }
  return cells;
}

} // namespace

std::vector<ExtremeRow> extreme_cell_rows() {
  const auto one_each = [](float others, float value) {
    std::vector<Corners> cells;
    for (std::size_t c = 0; c < 8; ++c) cells.push_back(constant(others)), cells.back()[c] = value;
    return cells;
  };
  const auto zero_faces = [] {
    std::vector<Corners> cells;
    for (int a = 0; a < 3; ++a)
      for (int side = 0; side < 2; ++side)
        for (const float rest : {1.f, -1.f}) {
          cells.push_back(constant(rest));
          for (int c = 0; c < 8; ++c)
            if ((c >> a & 1) == side) cells.back()[static_cast<std::size_t>(c)] = 0;
        }
    return cells;
  };
  return {
      judged("all-positive", "A cell of positive corners is not hit.",
             [] {
               return std::vector<Corners>{constant(1), constant(1e-30f), constant(FLT_MIN)};
             }),
      judged("all-negative", "A cell of negative corners is entered where the outside's samples end.",
             [] {
               return std::vector<Corners>{constant(-1), constant(-1e-30f), constant(-FLT_MIN)};
             }),
      judged(
          "one-zero", "One corner 0 among positive or negative ones.",
          [=] {
            std::vector<Corners> cells = one_each(1, 0);
            for (const Corners& f : one_each(-1, 0)) cells.push_back(f);
            return cells;
          },
          6),
      judged("face-of-zeros", "Four zero corners: the surface is the face.", zero_faces, 6),
      judged(
          "eight-zeros", "A cell full of zeros is all surface.",
          [] { return std::vector<Corners>{constant(0)}; }, 40),
      {"cells", "all-signs", "All 6561 cells with corners of -1, 0 and 1.", all_signs},
      judged("saddle", "Faces with signs + - + -, and a saddle through the cell.",
             [] {
               return std::vector<Corners>{{1, -1, -1, 1, 1, -1, -1, 1},
                                           {1, -1, -1, 1, -1, 1, 1, -1},
                                           {1, -1, -1, 1, 1, 1, 1, 1},
                                           {0.5f, -1, -2, 1, 0.25f, -1, -1, 3},
                                           {1, -0x1p-20f, -0x1p-20f, 1, 1, -1, -1, 1}};
             }),
      judged(
          "tunnel", "Two opposite corners negative, joined within the cell or not.",
          [] {
            std::vector<Corners> cells;
            for (const float w : {-0.1f, -0.5f, -0.99f, -1.f, -1.01f, -2.f, -10.f}) {
              cells.push_back(constant(1));
              cells.back()[0] = cells.back()[7] = w;
              cells.push_back({w, 1, 1, 1, 1, 0.5f, 1, w});
            }
            return cells;
          },
          6),
      {"cells", "double-root",
       "Tangents with values 0 and up to 64 units in the last place beside it are told apart.", double_root},
      {"cells", "triple-root", "Triple roots, and those nearly so, are found to the cube root of rounding.",
       triple_root},
      {"cells", "close-roots", "Of two roots 1e-6 to 1e-12 apart the first is found.", close_roots},
      {"cells", "roots-at-ends", "Roots at the very ends of a ray's piece count, exactly.", roots_at_ends},
      judged(
          "corners-1e-38", "Corners of 1e-38.", [] { return of_sizes({1e-38f}, 1); }, 6),
      judged(
          "corners-1e38", "Corners of 1e38, and up to the largest float.",
          [] {
            return of_sizes({1e38f, FLT_MAX}, 2);
          },
          6),
      judged(
          "corners-denormal", "Denormal corners.",
          [] {
            return of_sizes({1e-40f, 1e-44f, 1e-42f}, 3);
          },
          6),
      judged(
          "corners-mixed", "Corners of 1e-30 beside those of 1.",
          [] {
            return of_sizes({1e-30f, 1}, 4);
          },
          6, true),
      judged(
          "corners-of-all-sizes", "Corners from denormal to 1e38 in one cell.",
          [] {
            return of_sizes({1e-42f, 1e-30f, 1e-10f, 1, 1e10f, 1e30f, 3e38f}, 5);
          },
          6, true),
      judged(
          "linear", "f linear in the cell: c3 = c2 = 0.", [] { return planes(false); }, 6),
      judged(
          "tilted-plane", "f linear along a diagonal.", [] { return planes(true); }, 6),
      judged("quadratic", "f bilinear: c3 = 0 along every ray.",
             [] {
               return std::vector<Corners>{
                   {1, -2, 3, -1, 1, -2, 3, -1}, {0, -2, 3, 0, 0, -2, 3, 0}, {1, 1, -1, 5, 1, 1, -1, 5}};
             }),
  };
}

} // namespace levelray
