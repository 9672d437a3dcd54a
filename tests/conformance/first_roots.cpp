// What the approximate and the splitting intersectors promise of roots, against an oracle that isolates every
// one: `exact` has its own tests beside the contract's (intersectors.cpp).
#include "levelray/intersect/intersectors.hpp"
#include "support/catch.hpp"
#include "support/cell_segments.hpp"

#include <tuple>

using namespace levelray;
using namespace levelray::test;

namespace {

// Along the diagonal of a saddle: f = (1 - 2s)^2 + c, with a double root at 1/2 for c = 0.
CellSegment saddle(float c) {
  return cell_segment({1 + c, -1 + c, -1 + c, 1 + c, 1 + c, -1 + c, -1 + c, 1 + c}, cell_point(0, 0, 0.5),
                      cell_point(1, 1, 0.5));
}

// Along the diagonal the cubic with these Bernstein coefficients.
CellSegment with_bernstein(float b0, float b1, float b2, float b3) {
  return cell_segment({b0, b1, b1, b2, b1, b2, b2, b3}, cell_point(0, 0, 0), cell_point(1, 1, 1));
}

// The monotone piece of [0,1] that holds the root.
std::pair<Real, Real> piece_of(const CellCubic& cubic, Real root) {
  const std::vector<Real> ends = cubic.monotone_pieces(0, 1);
  for (std::size_t i = 0; i + 1 < ends.size(); ++i)
    if (root <= ends[i + 1]) return {ends[i], ends[i + 1]};
  return {ends.front(), ends.back()};
}

using Certified = std::tuple<Exact, Marmitt, SphereTracing>;

} // namespace

TEMPLATE_LIST_TEST_CASE("intersectors that look between the ends lose no first root and invent none", "",
                        Certified) {
  constexpr unsigned seed = 31;
  CAPTURE(TestType::name, seed);
  RandomSegments segments(seed);
  std::size_t hits = 0, lost = 0, invented = 0, in_doubt = 0, other_root = 0, passed = 0, disagree = 0;
  for (int i = 0; i < 300000; ++i) {
    const CellSegment s = segments.next();
    const SegmentOracle oracle(s);
    const double side = interpolate(s.corner, s.in) < 0 ? -1 : 1;
    // 2^-44 of the largest corner for the splits' power basis (segment_cubic.hpp).
    const Real doubt = 0x1p-44L * oracle.largest;
    Real least = 1e60L;
    const std::optional<Real> expected = first_crossing(oracle.cubic, side, 0, 1, least);
    CellRoot root;
    const bool found = TestType::find(s, side, root);
    disagree += found != TestType::exists(s, side);
    hits += found;
    if (found != bool(expected)) {
      if (std::fabs(least) <= doubt)
        ++in_doubt;
      else
        ++(found ? invented : lost);
      continue;
    }
    if (!found) continue;
    // Before the point for secondary rays nothing is below 0 by more than rounding.
    Real before = 1e60L;
    if (root.outside >= 0) first_crossing(oracle.cubic, side, 0, root.outside, before);
    passed += before < -doubt;
    // The place is on the piece of the first root: extrema of nearly flat cubics are known to the cube root
    // of 2^-53, and where a minimum is within the doubt either piece will do.
    const auto [low, high] = piece_of(oracle.cubic, *expected);
    const bool doubtful =
        std::fabs(side * oracle.cubic(low)) <= doubt || std::fabs(oracle.cubic(high)) <= doubt;
    other_root += !doubtful && !(root.at >= low - 1e-5L && root.at <= high + 1e-5L);
  }
  CAPTURE(hits, in_doubt);
  CHECK(lost == 0);
  CHECK(invented == 0);
  CHECK(passed == 0);
  CHECK(other_root == 0);
  CHECK(disagree == 0);
  CHECK(hits > 30000);
  CHECK(in_doubt < 100); // a few in 10^5, as the flat planes with tiny corners make
}

TEMPLATE_LIST_TEST_CASE("two roots in a cell, three, and touches are told by those that split", "",
                        Certified) {
  CellRoot root;
  REQUIRE(TestType::find(saddle(-0x1p-10f), 1, root)); // roots 1/2 -+ 2^-6
  CHECK(root.at >= 0);
  CHECK(root.at <= 0.5 + 0x1p-6);
  CHECK_FALSE(TestType::find(saddle(0x1p-22f), 1, root));
  CHECK_FALSE(TestType::exists(saddle(0x1p-22f), 1));
  REQUIRE(TestType::find(saddle(0), 1, root));
  CHECK(std::fabs(root.at - 0.5) <= 1e-7); // a double root is known to the square root of 2^-53
  // (1-4s)(1-2s)(3-4s)/3: roots 1/4, 1/2, 3/4; extrema at 1/2 -+ 1/sqrt 48.
  REQUIRE(TestType::find(with_bernstein(1, -13.f / 9, 13.f / 9, -1), 1, root));
  CHECK(root.at > 0.2);
  CHECK(root.at < 0.5 - 0.14);
}

TEST_CASE("sphere tracing ends within its steps wherever the minimum is") {
  int most = 0;
  for (int exponent = 4; exponent < 60; ++exponent)
    for (const double sign : {-1.0, 1.0}) {
      const CellSegment s = saddle(static_cast<float>(sign * std::ldexp(1, -exponent)));
      int counted = 0;
      CellRoot root;
      const bool found = SphereTracing::find(s, 1, root, [&](int n) { counted += n; });
      most = std::max(most, counted);
      CAPTURE(exponent, sign);
      CHECK(found == (sign < 0 || exponent > 24)); // corners are rounded to floats: 2^-25 is lost
    }
  CHECK(most <= SphereTracing::max_steps + 2 + bernstein_interpolations);
  CHECK(most > SphereTracing::max_steps); // the last resort was needed
}

TEST_CASE("the slope bound of sphere tracing bounds the slope, and is attained") {
  constexpr unsigned seed = 32;
  CAPTURE(seed);
  RandomSegments segments(seed);
  double closest = 0;
  for (int i = 0; i < 20000; ++i) {
    const CellSegment s = segments.next();
    const SegmentOracle oracle(s);
    const double bound = SphereTracing::slope_bound(s);
    for (int k = 0; k <= 32; ++k) {
      const Real slope = std::fabs(oracle.slope(k / Real(32)));
      // The oracle's own sums of eight corners.
      REQUIRE(slope <= bound * (1 + 0x1p-48L) + 0x1p-56L * oracle.largest);
      if (bound > 0) closest = std::max(closest, static_cast<double>(slope) / bound);
    }
  }
  CHECK(closest > 0.99); // fields that are nearly linear
}

TEST_CASE("newton decides by the ends as false position does, and finds a root to rounding") {
  constexpr unsigned seed = 33;
  CAPTURE(seed);
  RandomSegments segments(seed);
  std::size_t hits = 0, differences = 0, misplaced = 0, disagree = 0, two_roots = 0;
  for (int i = 0; i < 300000; ++i) {
    const CellSegment s = segments.next();
    const SegmentOracle oracle(s);
    const double side = interpolate(s.corner, s.in) < 0 ? -1 : 1;
    CellRoot root, other;
    const bool found = Newton::find(s, side, root);
    disagree += found != Newton::exists(s, side);
    differences += found != FalsePosition<1>::find(s, side, other);
    Real least = 1e60L;
    two_roots += !found && first_crossing(oracle.cubic, side, 0, 1, least) && least < -oracle.doubt;
    if (!found) continue;
    ++hits;
    Real slope = 0;
    for (int k = 0; k <= 16; ++k) slope = std::max(slope, std::fabs(oracle.slope(k / Real(16))));
    // 2^-36 of the segment, where the search stops; rounding of the power basis.
    misplaced += std::fabs(oracle.cubic(root.at)) > 0x1p-36L * slope + 0x1p-44L * oracle.largest;
  }
  CAPTURE(hits);
  CHECK(differences == 0);
  CHECK(disagree == 0);
  CHECK(misplaced == 0);
  CHECK(hits > 30000);
  CHECK(two_roots > 1000); // which it loses, as documented
  CHECK_FALSE(Newton::exists(saddle(-0x1p-10f), 1));
}
