// Every intersector against one contract, and `exact` against an oracle that isolates every root.
#include "levelray/intersect/intersectors.hpp"
#include "support/catch.hpp"
#include "support/cell_segments.hpp"

#include <array>
#include <limits>
#include <random>
#include <set>

using namespace levelray;
using namespace levelray::test;

namespace {

CellPoint point(double x, double y, double z) {
  return cell_point(x, y, z);
}

CellSegment segment(const std::array<float, 8>& corner, CellPoint in, CellPoint out) {
  return cell_segment(corner, in, out);
}

// f = x - at, along x through the middle of the cell.
CellSegment ramp(float low, float high) {
  return segment({low, high, low, high, low, high, low, high}, point(0, 0.5, 0.5), point(1, 0.5, 0.5));
}

} // namespace

TEMPLATE_LIST_TEST_CASE("an intersector says what it is", "", Intersectors) {
  CHECK_FALSE(TestType::name.empty());
  CHECK_FALSE(TestType::source.empty());
  std::set<std::string> names;
  for (const std::string& name : method_names<Intersectors>()) CHECK(names.insert(name).second);
  CHECK(names.count(std::string(canonical_intersector("false-position"))) == 1);
}

TEMPLATE_LIST_TEST_CASE("an intersector finds the root of a linear field", "", Intersectors) {
  for (const double side : {1.0, -1.0}) {
    for (const float start : {0.25f, 0.5f, 0.75f}) {
      const float low = static_cast<float>(side) * start;
      const CellSegment s = ramp(low, low - static_cast<float>(side));
      CellRoot root;
      REQUIRE(TestType::find(s, side, root));
      CHECK(TestType::exists(s, side));
      // The midpoint method is half a cell off at most; the others are exact for linear fields.
      if (TestType::name == "midpoint")
        CHECK(root.at == 0.5);
      else
        CHECK(std::fabs(root.at - start) <= 0x1p-50);
      // The point given for secondary rays is on the side of the beginning.
      REQUIRE(root.outside >= 0);
      CHECK(root.outside <= root.at);
      CHECK(side * interpolate(s.corner, point_at(s, root.outside)) > safety_margin(s) / 2);
    }
  }
}

TEMPLATE_LIST_TEST_CASE("a root at either end of the segment counts", "", Intersectors) {
  CellRoot root;
  REQUIRE(TestType::find(ramp(0, 1), 1, root));
  if (TestType::name != "midpoint") CHECK(root.at == 0);
  CHECK(TestType::exists(ramp(0, 1), 1));
  REQUIRE(TestType::find(ramp(1, 0), 1, root));
  if (TestType::name != "midpoint") CHECK(root.at == 1);
  CHECK(TestType::exists(ramp(1, 0), 1));
  // Eight zeros: on the surface all along.
  REQUIRE(TestType::find(ramp(0, 0), 1, root));
  if (TestType::name != "midpoint") CHECK(root.at == 0);
}

TEMPLATE_LIST_TEST_CASE("a segment that begins beyond the surface is hit at its start", "", Intersectors) {
  CellRoot root;
  REQUIRE(TestType::find(ramp(-0.1f, -1), 1, root));
  if (TestType::name != "midpoint") {
    CHECK(root.at == 0);
    CHECK(root.outside == CellRoot::nowhere);
  }
}

TEMPLATE_LIST_TEST_CASE("a cell without a root is a miss", "", Intersectors) {
  if (TestType::name == "midpoint") return; // which by definition hits every cell it is shown
  CellRoot root;
  // A corner is negative, but the chord stays clear of it.
  const CellSegment s = segment({1, 1, 1, 1, 1, 1, 1, -1}, point(0, 0.25, 0.25), point(1, 0.25, 0.25));
  CHECK_FALSE(TestType::find(s, 1, root));
  CHECK_FALSE(TestType::exists(s, 1));
}

TEMPLATE_LIST_TEST_CASE("NaN corners neither hang nor give a place beyond the segment", "", Intersectors) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (int c = 0; c < 8; ++c) {
    std::array<float, 8> corner = {1, -1, 1, -1, 1, -1, 1, -1};
    corner[static_cast<std::size_t>(c)] = nan;
    CellRoot root;
    if (TestType::find(segment(corner, point(0, 0.3, 0.2), point(1, 0.6, 0.4)), 1, root) &&
        root.at == root.at) {
      CHECK(root.at >= 0);
      CHECK(root.at <= 1);
    }
  }
}

TEMPLATE_LIST_TEST_CASE("find and exists agree on random cells", "", Intersectors) {
  std::mt19937_64 engine(4);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int i = 0; i < 20000; ++i) {
    std::array<float, 8> corner;
    for (float& c : corner) c = static_cast<float>(2 * unit(engine) - 1);
    const CellSegment s =
        segment(corner, point(0, unit(engine), unit(engine)), point(unit(engine), 1, unit(engine)));
    const double side = interpolate(s.corner, s.in) < 0 ? -1 : 1;
    CellRoot root;
    const bool found = TestType::find(s, side, root);
    REQUIRE(found == TestType::exists(s, side));
    if (!found) continue;
    REQUIRE((root.at >= 0 && root.at <= 1));
    REQUIRE(root.outside <= root.at);
    if (root.outside >= 0)
      REQUIRE(side * interpolate(s.corner, point_at(s, root.outside)) > safety_margin(s) / 2);
  }
}

TEST_CASE("false position finds the root of a monotone cubic more closely with every step") {
  const CellSegment s =
      segment({0.2f, 1, 0.5f, 1.2f, -0.3f, 0.4f, -0.1f, -2}, point(0, 0, 0), point(1, 1, 1));
  CellRoot exact, root;
  REQUIRE(Exact::find(s, 1, exact));
  double last = 1;
  const auto closer = [&]<class I>(I) {
    REQUIRE(I::find(s, 1, root));
    CHECK(std::fabs(root.at - exact.at) <= last);
    last = std::fabs(root.at - exact.at);
  };
  closer(FalsePosition<1>{}), closer(FalsePosition<2>{}), closer(FalsePosition<3>{}),
      closer(FalsePosition<4>{});
}

TEST_CASE("exact finds double roots, and decides touches by the sign of a computable value") {
  // Along the diagonal of a saddle: f = (1 - 2s)^2 + c, with its double root at 1/2 for c = 0; corners are
  // sums of few powers of two, so everything is computed exactly.
  const auto saddle = [](float c) {
    return segment({1 + c, -1 + c, -1 + c, 1 + c, 1 + c, -1 + c, -1 + c, 1 + c}, point(0, 0, 0.5),
                   point(1, 1, 0.5));
  };
  CellRoot root;
  REQUIRE(Exact::find(saddle(0), 1, root));
  CHECK(std::fabs(root.at - 0.5) <= 1e-7); // a double root is known to the square root of 2^-53
  CHECK(Exact::exists(saddle(0), 1));
  CHECK_FALSE(Exact::find(saddle(0x1p-22f), 1, root));
  REQUIRE(Exact::find(saddle(-0x1p-22f), 1, root));
  CHECK(std::fabs(root.at - (0.5 - 0.5 * 0x1p-11)) <= 1e-9); // (1 - 2s)^2 = 2^-22
  CHECK_FALSE(
      FalsePosition<4>::exists(saddle(-0x1p-22f), 1)); // the paper's test sees equal signs at the ends
}

TEST_CASE("exact takes the first of three roots, and a triple root") {
  // f along the diagonal is the cubic with Bernstein coefficients b: put b0 and b3 at the ends of the
  // diagonal, b1 and b2 on the corners next to them.
  const auto cubic = [](float b0, float b1, float b2, float b3) {
    return segment({b0, b1, b1, b2, b1, b2, b2, b3}, point(0, 0, 0), point(1, 1, 1));
  };
  CellRoot root;
  // (1-4s)(1-2s)(3-4s)/3: roots 1/4, 1/2, 3/4.
  const CellSegment three = cubic(1, -13.f / 9, 13.f / 9, -1);
  REQUIRE(Exact::find(three, 1, root));
  CHECK(std::fabs(root.at - 0.25) <= 1e-6);           // 13/9 is rounded to float, 2^-24 against a slope of 3
  REQUIRE(Exact::find(cubic(1, -1, 1, -1), 1, root)); // (1-2s)^3
  CHECK(std::fabs(root.at - 0.5) <= 1e-5);            // the cube root of 2^-53
  CHECK_FALSE(Exact::exists(cubic(1, 1, 1, 1), 1));
  CHECK_FALSE(Exact::exists(cubic(1, -0.1f, -0.1f, 1), 1)); // dips to 0.175: the hull alone proves nothing
  CHECK(Exact::exists(cubic(1, -0.4f, -0.4f, 1), 1));       // dips to -0.05
}

TEST_CASE("exact loses no root and invents none in a million random cells over 16 decades") {
  constexpr unsigned seed = 20;
  CAPTURE(seed);
  std::mt19937_64 engine(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  const auto random = [&](double low, double high) { return low + (high - low) * unit(engine); };
  std::uint64_t hits = 0, lost = 0, invented = 0, in_doubt = 0, misplaced = 0, disagree = 0;
  for (int i = 0; i < 1000000; ++i) {
    // Corners: all of one decade; or each of its own; or a tilted plane, nearly flat, so that roots are
    // doubtful.
    std::array<float, 8> corner;
    const double scale = std::pow(10, random(-8, 8));
    const double a = random(-1, 1), b = random(-1, 1), c = random(-1, 1), e = random(-2, 2);
    const double bend = std::pow(10, random(-8, 0));
    for (int k = 0; k < 8; ++k) {
      const double noise = random(-1, 1);
      double value = 0;
      if (i % 3 == 0)
        value = scale * noise;
      else if (i % 3 == 1)
        value = noise * std::pow(10, random(-8, 8));
      else
        value = scale * (a * (k & 1) + b * (k >> 1 & 1) + c * (k >> 2) + e + bend * noise);
      corner[static_cast<std::size_t>(k)] = static_cast<float>(value);
    }
    // Chords: from face to face, or short, or along an axis.
    double in[3], out[3];
    for (int k = 0; k < 3; ++k) in[k] = unit(engine), out[k] = unit(engine);
    const int axis = static_cast<int>(3 * unit(engine)), kind = static_cast<int>(4 * unit(engine));
    if (kind < 2) in[axis] = 0, out[(axis + kind) % 3] = 1;
    if (kind == 2)
      for (int k = 0; k < 3; ++k) out[k] = std::clamp(in[k] + 1e-3 * (out[k] - in[k]), 0.0, 1.0);
    if (kind == 3)
      for (int k = 0; k < 3; ++k) in[k] = k == axis ? 0 : in[k], out[k] = k == axis ? 1 : in[k];
    const CellSegment s = segment(corner, point(in[0], in[1], in[2]), point(out[0], out[1], out[2]));

    const SegmentOracle oracle(s);
    const double side = interpolate(s.corner, s.in) < 0 ? -1 : 1;
    Real least = 1e60L;
    const std::optional<Real> expected = first_crossing(oracle.cubic, side, 0, 1, least);
    CellRoot root;
    const bool found = Exact::find(s, side, root);
    disagree += found != Exact::exists(s, side);
    hits += found;
    if (found != bool(expected)) {
      // Whatever either says, an answer is wrong only if f is clear of 0 by more than rounding.
      if (std::fabs(least) <= oracle.doubt)
        ++in_doubt;
      else
        ++(found ? invented : lost);
      continue;
    }
    if (!found) continue;
    // The place: the polynomial there is 0 but for rounding, and for the 2^-40 of the chord that the search
    // stops at; and before it, it does not fall below 0 by more than rounding.
    Real slope = 0;
    for (int k = 0; k <= 16; ++k) {
      const Real t = k / Real(16);
      slope = std::max(
          slope, std::fabs(oracle.cubic.c[1] + t * (2 * oracle.cubic.c[2] + t * 3 * oracle.cubic.c[3])));
    }
    const Real allowed = oracle.doubt + 0x1p-38L * slope;
    Real before = 1e60L;
    first_crossing(oracle.cubic, side, 0, root.at, before);
    if (std::fabs(oracle.cubic(root.at)) > allowed || before < -allowed) ++misplaced;
  }
  CAPTURE(hits, in_doubt);
  CHECK(lost == 0);
  CHECK(invented == 0);
  CHECK(misplaced == 0);
  CHECK(disagree == 0);
  CHECK(hits > 100000);
  CHECK(in_doubt < 100); // one in 10^4: the flat planes with zero corners make some
}
