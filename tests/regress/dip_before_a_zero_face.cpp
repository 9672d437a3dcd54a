// A ray that comes through the surface and leaves the cell by a face whose samples are all 0 was hit at that
// face, not at the surface: the end's value, 0 but for rounding, passed for a change of sign. And one that
// leaves by an edge of zeros was hit there, if the cubic's value and slope at the end were 0 but for
// rounding.
#include "levelray/intersect/exact.hpp"
#include "support/catch.hpp"
#include "support/trace_fixtures.hpp"

using namespace levelray;
using namespace levelray::test;

TEST_CASE("a surface in front of a face of zeros is hit before the face") {
  RandomRays random(20);
  std::size_t wrong = 0, lost = 0;
  for (int i = 0; i < 200000; ++i) {
    // f = (1 - z) (a + (b - a) x) with x from x0 to x1, z from 0 to 1: roots where the second factor is 0,
    // and at the end.
    const auto a = static_cast<float>(random.uniform(0.1, 3)),
               b = -static_cast<float>(random.uniform(0.1, 3));
    CellSegment s;
    for (int c = 0; c < 4; ++c) s.corner[c] = c & 1 ? b : a;
    s.error = 3 * 0x1p-20f + 0x1p-120f;
    const double x0 = random.uniform(0, 0.3), x1 = random.uniform(0.7, 1), y = random.uniform(0, 1);
    const double in[3] = {x0, y, 0}, out[3] = {x1, y, 1};
    for (int k = 0; k < 3; ++k) {
      s.in.x[k] = in[k], s.in.rest[k] = 1 - in[k];
      s.out.x[k] = out[k], s.out.rest[k] = 1 - out[k];
    }
    const double g0 = a + (double(b) - a) * x0, g1 = a + (double(b) - a) * x1;
    if (!(g0 > 0.01 && g1 < -0.01)) continue;
    CellRoot root;
    if (!Exact::find(s, 1, root))
      ++lost;
    else // some 2^-50 of the corners over a slope of at least 0.01^2
      wrong += std::fabs(root.at - g0 / (g0 - g1)) > 1e-9;
  }
  CHECK(lost == 0);
  CHECK(wrong == 0);
}

TEST_CASE("a surface in front of an edge of zeros is hit before the edge") {
  RandomRays random(21);
  std::size_t wrong = 0, lost = 0, tried = 0;
  for (int i = 0; i < 400000; ++i) {
    // f = (1 - x) (1 - z) (a + (b - a) y), towards the edge x = z = 1 or up to some roundings beside it.
    const auto a = static_cast<float>(random.uniform(0.1, 3)),
               b = -static_cast<float>(random.uniform(0.1, 3));
    CellSegment s;
    s.corner[0] = a, s.corner[2] = b;
    s.error = 3 * 0x1p-20f + 0x1p-120f;
    const double y0 = random.uniform(0, 0.3), y1 = random.uniform(0.7, 1);
    const double in[3] = {random.uniform(0, 0.5), y0, 0};
    const auto near_one = [&](double x) { return x < 0.3 ? 1 : 1 - x * 0x1p-52; };
    const double out[3] = {near_one(random.uniform(0, 1)), y1, near_one(random.uniform(0, 1))};
    for (int k = 0; k < 3; ++k) {
      s.in.x[k] = in[k], s.in.rest[k] = 1 - in[k];
      s.out.x[k] = out[k], s.out.rest[k] = 1 - out[k];
    }
    if (i % 3 == 0) s.out.rest[0] = 1e-16; // rounded on its own
    const double g0 = a + (double(b) - a) * y0, g1 = a + (double(b) - a) * y1;
    if (!(g0 > 0.01 && g1 < -0.01)) continue;
    ++tried;
    CellRoot root;
    if (!Exact::find(s, 1, root))
      ++lost;
    else // some 2^-50 of the corners over a slope of at least 0.01^2 times what is left of (1 - x) (1 - z)
      wrong += std::fabs(root.at - g0 / (g0 - g1)) > 1e-6;
  }
  CHECK(tried > 100000);
  CHECK(lost == 0);
  CHECK(wrong == 0);
}
