// Differences of pictures, against sums done by hand.
#include "levelray/measure/compare_pictures.hpp"
#include "support/catch.hpp"
#include "support/write_exr.hpp"

#include <cmath>
#include <limits>

using namespace levelray;
using namespace levelray::test;
using Type = Picture::Type;

namespace {

constexpr float inf = std::numeric_limits<float>::infinity();
const float nan_value = std::numeric_limits<float>::quiet_NaN();

Picture two_channels() {
  return blank_picture(10, 10, {{"R", Type::float32}, {"Z", Type::float32}});
}

Verdict verdict_of(const Picture& a, const Picture& b, const Thresholds& thresholds) {
  return compare_pictures(a, b, {thresholds, false}).pixels.verdict();
}

} // namespace

TEST_CASE("statistics of differences are those of idiff") {
  const Picture a = two_channels();
  Picture b = a;
  set(b.channels[0], 23, 0.5f); // pixel (3, 2)
  set(b.channels[1], 23, -0.25f);
  set(b.channels[1], 99, 4.0f); // pixel (9, 9)
  const PictureComparison r = compare_pictures(a, b);
  CHECK(r.mismatch.empty());
  CHECK(r.all.mean == Approx((0.5 + 0.25 + 4) / 200));
  CHECK(r.all.rms == Approx(std::sqrt((0.25 + 0.0625 + 16) / 200)));
  CHECK(r.all.psnr == Approx(20 * std::log10(4 / r.all.rms))); // the largest value is 4
  CHECK(r.all.max == 4);
  CHECK(r.all.max_x == 9);
  CHECK(r.all.max_y == 9);
  CHECK(r.max_channel == "Z");
  CHECK(r.channels[0].first == "R");
  CHECK(r.channels[0].second.mean == Approx(0.5 / 100));
  CHECK(r.channels[0].second.max_x == 3);
  CHECK(r.channels[0].second.max_y == 2);
  CHECK(r.channels[0].second.psnr == Approx(20 * std::log10(1 / std::sqrt(0.25 / 100)))); // at least 1
  CHECK(r.pixels.total() == 100);
  CHECK(r.pixels.failed() == 2); // pixels, not values
  CHECK(std::isinf(compare_pictures(a, a).all.psnr));
  CHECK(compare_pictures(a, a).pixels.verdict() == Verdict::pass);
}

TEST_CASE("thresholds mean what idiff's documentation says") {
  const Picture a = two_channels();
  Picture b = a;
  for (std::size_t i = 0; i < 5; ++i) set(b.channels[0], i, 0.125f); // 5 % of the pixels
  set(b.channels[1], 50, 0.5f);                                      // and one more
  Thresholds t;
  CHECK(verdict_of(a, b, t) == Verdict::failure);
  t.fail = 0.125; // as much is not more
  CHECK(verdict_of(a, b, t) == Verdict::failure);
  t.fail = 0.5;
  CHECK(verdict_of(a, b, t) == Verdict::warning);
  t.warn = 0.5;
  CHECK(verdict_of(a, b, t) == Verdict::pass);
  t = {};
  t.fail_percent = 6; // as many are not more
  t.warn_percent = 6;
  CHECK(verdict_of(a, b, t) == Verdict::pass);
  t.fail_percent = 5.9;
  CHECK(verdict_of(a, b, t) == Verdict::failure);
  t.fail_percent = 10;
  t.hard_fail = 0.49;
  CHECK(verdict_of(a, b, t) == Verdict::failure);
  t.hard_fail = 0.5;
  CHECK(verdict_of(a, b, t) == Verdict::pass);
  t.hard_warn = 0.25;
  CHECK(verdict_of(a, b, t) == Verdict::warning);
  t = {};
  t.allow_failures = 6;
  t.hard_fail = 0.1; // "by any amount"
  CHECK(verdict_of(a, b, t) == Verdict::warning);
  t.allow_failures = 5;
  CHECK(verdict_of(a, b, t) == Verdict::failure);
  t = {};
  t.fail = 1; // below the soft threshold the hard one still counts
  t.hard_fail = 0.25;
  CHECK(verdict_of(a, b, t) == Verdict::failure);
}

TEST_CASE("NaN equals NaN unless told otherwise, an infinity equals itself, and neither equals a number") {
  Picture a = two_channels(), b = a;
  set(a.channels[0], 0, nan_value);
  set(b.channels[0], 0, -nan_value);
  set(a.channels[0], 1, inf);
  set(b.channels[0], 1, inf);
  CHECK(compare_pictures(a, b).pixels.failed() == 0);
  CHECK(compare_pictures(a, b, {{}, true}).pixels.failed() == 1);
  set(b.channels[0], 1, -inf);
  set(b.channels[1], 2, inf);
  set(b.channels[1], 3, nan_value);
  set(b.channels[1], 4, 0.5f);
  const PictureComparison r = compare_pictures(a, b);
  CHECK(r.pixels.failed() == 4);
  CHECK(r.all.not_finite == 3);
  CHECK(std::isinf(r.all.max));
  CHECK(r.all.max_x == 1); // the first of them
  CHECK(r.all.mean == Approx(0.5 / (200 - 3)));
}

TEST_CASE("integers are compared exactly") {
  Picture a = blank_picture(2, 1, {{"id", Type::uint32}});
  a.channels[0].words = {0xFFFFFFFF, 16777217};
  Picture b = a;
  b.channels[0].words = {0xFFFFFFFE, 16777216}; // the same floats
  CHECK(compare_pictures(a, b).all.max == 1);
  CHECK(compare_pictures(a, b).pixels.failed() == 2);
}

TEST_CASE("different sizes and channels do not match, and are named") {
  const Picture a = two_channels();
  const Picture small = blank_picture(9, 10, {{"R", Type::float32}, {"Z", Type::float32}});
  CHECK(compare_pictures(a, small).mismatch == "different sizes: 10 x 10 and 9 x 10");
  const Picture other = blank_picture(10, 10, {{"G", Type::float32}, {"Z", Type::float32}});
  CHECK(compare_pictures(a, other).mismatch ==
        "different channels: 2 and 2; only in the first: R; only in the second: G");
  const PixelBox display({0, 0}, {9, 9});
  const Picture near_picture = blank_picture({{0, 0}, {0, 0}}, display, {{"Y", Type::half}});
  const Picture far_picture = blank_picture({{2000000000, 0}, {2000000000, 0}}, display, {{"Y", Type::half}});
  CHECK(compare_pictures(near_picture, far_picture).mismatch ==
        "data windows far apart: 1 x 1 and 1 x 1 at (2000000000, 0)");
}

TEST_CASE("where only one picture has data, the other is 0") {
  const PixelBox display({0, 0}, {9, 9});
  Picture a = blank_picture({{0, 0}, {5, 9}}, display, {{"Y", Type::half}});
  Picture b = blank_picture({{4, 2}, {11, 9}}, display, {{"Y", Type::half}});
  CHECK(compare_pictures(a, b).pixels.failed() == 0);
  CHECK(compare_pictures(a, b).pixels.total() == 120);
  REQUIRE(compare_pictures(a, b).remarks.size() == 1);
  CHECK_THAT(compare_pictures(a, b).remarks[0], Catch::Contains("6 x 10 and 8 x 8 at (4, 2)"));
  set(a.channels[0], 6 * 3 + 4, 2); // (4, 3) in both
  set(b.channels[0], 8 * 1 + 0, 2);
  set(a.channels[0], 0, -1);        // (0, 0) in a alone
  set(b.channels[0], 8 * 7 + 7, 3); // (11, 9) in b alone
  const PictureComparison r = compare_pictures(a, b);
  CHECK(r.pixels.failed() == 2);
  CHECK(r.all.max_x == 11);
  CHECK(r.all.max_y == 9);
  const Image difference = signed_difference(a, b, r);
  CHECK(difference.width == 12);
  CHECK(difference.channels[0].values[0] == -1);
  CHECK(difference.channels[0].values[119] == -3);
  CHECK(difference.channels[0].values[12 * 3 + 4] == 0);
}

TEST_CASE("false colours tell no difference, small ones, failures and what is not finite") {
  Picture a = blank_picture(5, 1, {{"Y", Type::float32}}), b = a;
  set(b.channels[0], 1, 0.05f);
  set(b.channels[0], 2, 0.11f);
  set(b.channels[0], 3, 100);
  set(b.channels[0], 4, inf);
  PictureCompareOptions options;
  options.thresholds.fail = 0.1;
  const Image image = difference_colours(a, b, compare_pictures(a, b, options), options);
  const auto colour = [&](std::size_t i) {
    return std::array{image.channels[0].values[i], image.channels[1].values[i], image.channels[2].values[i],
                      image.channels[3].values[i]};
  };
  CHECK(colour(0) == std::array{0.0f, 0.0f, 0.0f, 1.0f});
  CHECK(colour(1)[0] == Approx(0.1).epsilon(1e-6)); // the double 0.05f/0.1 rounded
  CHECK(colour(1)[2] == colour(1)[0]);
  CHECK(colour(2)[0] > 0.5f);
  CHECK(colour(2)[1] == 0);
  CHECK(colour(3) == std::array{1.0f, 1.0f, 1.0f, 1.0f});
  CHECK(colour(4) == std::array{1.0f, 0.0f, 1.0f, 1.0f});
}
