// Who watches the oracle? Cubics with roots known by hand; its two ways against each other; a third tracer.
#include "levelray/trace/level_set.hpp"
#include "oracle/exact_cubic.hpp"
#include "oracle/ray_oracle.hpp"
#include "support/catch.hpp"
#include "support/reference_tracer.hpp"
#include "support/trace_fixtures.hpp"

using namespace levelray;
using namespace levelray::test;

namespace {

// scale * (u - r0)(u - r1)(u - r2), or fewer factors, in Bernstein form; exact where r are short numbers.
ExactCubic with_roots(double scale, std::initializer_list<double> roots) {
  Dyadic power[4] = {Dyadic(scale), Dyadic(), Dyadic(), Dyadic()};
  for (const double r : roots)
    for (int k = 3; k >= 0; --k) power[k] = (k ? power[k - 1] : Dyadic()) - Dyadic(r) * power[k];
  // b_k times 3: sum of C(k,i)/C(3,i) power_i.
  const Dyadic three(3), two(2);
  return {{three * power[0], three * power[0] + power[1], three * power[0] + two * power[1] + power[2],
           three * (power[0] + power[1] + power[2] + power[3])}};
}

} // namespace

TEST_CASE("exact roots of cubics are found, once each, with the signs between them") {
  const struct {
    double scale;
    std::initializer_list<double> roots, expected;
    int before;
    std::vector<int> after;
  } cases[] = {{1, {0.25, 0.5, 0.75}, {0.25, 0.5, 0.75}, -1, {1, -1, 1}},
               {1, {0.5, 0.5, 2}, {0.5}, -1, {-1}},
               {-1, {0.5, 0.5, 0.75}, {0.5, 0.75}, 1, {1, -1}},
               {1, {0.5, 0.5, 0.5}, {0.5}, -1, {1}},
               {1, {0, 1, 0.5}, {0, 0.5, 1}, 0, {1, -1, 0}},
               {1, {0, 0, 0.5}, {0, 0.5}, 0, {-1, 1}},
               {-2, {1, 1, -3}, {1}, -1, {0}},
               {1, {-0.5, 1.5, 3}, {}, 1, {}},
               {1, {0.25, 0.75}, {0.25, 0.75}, 1, {-1, 1}},
               {1, {0.25}, {0.25}, -1, {1}},
               {1, {0.5, 0.5 + 0x1p-50, 0.5 - 0x1p-50}, {0.5 - 0x1p-50, 0.5, 0.5 + 0x1p-50}, -1, {1, -1, 1}}};
  for (const auto& c : cases) {
    int before = 7;
    const std::vector<ExactRoot> roots = exact_roots(with_roots(c.scale, c.roots), before);
    REQUIRE(roots.size() == c.expected.size());
    CHECK(before == c.before);
    std::size_t i = 0;
    for (const double u : c.expected) {
      CHECK(static_cast<double>(std::fabs(roots[i].u - u)) <= static_cast<double>(roots[i].error));
      CHECK(roots[i].error <= 0x1p-55L);
      CHECK(roots[i].sign_after == c.after[i]);
      ++i;
    }
  }
  int before = 7;
  const std::vector<ExactRoot> roots = exact_roots(with_roots(0, {}), before);
  CHECK(before == 0);
  CHECK(roots.size() == 2);
}

TEST_CASE("the oracle's long double and its exact numbers say the same, and so does the reference tracer") {
  const Shape shapes[] = {
      {"torus", torus_grid(10, 1)}, {"plate", slab_grid(0.8, 12)}, {"gyroid", gyroid_grid(14)}};
  for (const Shape& shape : shapes) {
    const RayOracle oracle(shape.grid);
    const ReferenceTracer reference(shape.grid);
    RandomRays random(61);
    std::size_t different = 0, roots = 0, unlike_reference = 0, odd = 0;
    for (int i = 0; i < 900; ++i) {
      WorldRay ray = random.through(active_box(shape.grid));
      if (i % 3 == 0) ray.origin = random.in_box(active_box(shape.grid));
      if (i % 4 == 0) ray.t_max = random.uniform(0, 60);
      const OracleAnswer fast = oracle.ask(ray), exact = oracle.ask(ray, true);
      if (!exact.exactly) continue; // the interval does not meet the grid's box
      CHECK_FALSE(fast.exactly);    // nothing in doubt in random rays
      different += fast.first_sign != exact.first_sign || fast.last_sign != exact.last_sign ||
                   fast.roots.size() != exact.roots.size();
      for (std::size_t r = 0; r < fast.roots.size() && r < exact.roots.size(); ++r) {
        ++roots;
        different +=
            !(std::fabs(fast.roots[r].t - exact.roots[r].t) <= fast.roots[r].error + exact.roots[r].error);
        different += fast.roots[r].sign_after != exact.roots[r].sign_after;
      }
      odd += (exact.roots.size() % 2 != 0) != (exact.first_sign != exact.last_sign);
      if (std::isfinite(ray.t_max)) odd += oracle.sign_at(ray, ray.t_max) != exact.last_sign;
      const ReferenceHit hit = reference.closest(ray);
      unlike_reference +=
          hit.hit != !exact.roots.empty() ||
          (hit.hit && std::fabs(hit.t - exact.roots[0].t) > 1e-9L); // grazes: 2^-60 to its root
    }
    CAPTURE(shape.name, roots);
    CHECK(roots > 100);
    CHECK(different == 0);
    CHECK(odd == 0);
    CHECK(unlike_reference == 0);
  }
}

TEST_CASE("the oracle knows touches and beginnings on the surface exactly") {
  // Integer samples: planes x = 2 and x = -2, exact zeros.
  const BlockGrid grid = sample_grid([](const Vec3d& p) { return std::fabs(p.x) - 2; }, 1, 3,
                                     Box3d(Vec3d(-9, -8, -7), Vec3d(8, 7, 9)));
  const RayOracle oracle(grid);
  WorldRay ray;
  ray.origin = Vec3d(-20, 0.25, 0.5);
  ray.direction = Vec3d(1, 0, 0);
  OracleAnswer answer = oracle.ask(ray);
  REQUIRE(answer.roots.size() == 2);
  CHECK(answer.roots[0].t == 18);
  CHECK_FALSE(answer.roots[0].touch);
  ray.t_max = 18;
  answer = oracle.ask(ray);
  REQUIRE(answer.roots.size() == 1);
  CHECK(answer.roots[0].touch);
  CHECK(answer.last_sign == 0);
  ray.origin.x = -2;
  answer = oracle.ask(ray);
  CHECK(answer.first_sign == 0);
  REQUIRE(answer.roots.size() == 2);
  CHECK(answer.roots[0].t == 0);
  ray.origin = Vec3d(2, 0.25, 0.5); // along the surface's plane, in the faces between cells
  ray.direction = Vec3d(0, 1, 0);
  ray.t_max = 3;
  answer = oracle.ask(ray);
  CHECK(answer.roots.size() == 1);
  CHECK(answer.last_sign == 0);
}
