#include "levelray/render/false_colour.hpp"
#include "support/catch.hpp"

using namespace levelray;

TEST_CASE("false colours go from black to white and never get darker") {
  CHECK(false_colour(0) == Vec3f(0, 0, 0));
  CHECK(false_colour(1) == Vec3f(1, 1, 1));
  CHECK(false_colour(-3) == false_colour(0));
  CHECK(false_colour(7) == false_colour(1));
  double last = -1;
  for (int i = 0; i <= 256; ++i) {
    const Vec3f c = false_colour(i / 256.0);
    const double luminance = 0.2126 * double(c.x) + 0.7152 * double(c.y) + 0.0722 * double(c.z); // Rec. 709
    CAPTURE(i);
    REQUIRE(luminance > last);
    last = luminance;
  }
}

TEST_CASE("a channel is shown from 0 to its largest value") {
  Image image{2, 2, {}};
  for (const char* name : {"R", "G", "B", "A"}) image.add(name);
  image.add("steps") = {0, 4, 2, 8};
  CHECK(show_channel(image, "steps") == 8);
  const float fractions[] = {0, 0.5f, 0.25f, 1};
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3f expected = false_colour(double(fractions[i]));
    CHECK((*image.find("R"))[i] == expected.x);
    CHECK((*image.find("G"))[i] == expected.y);
    CHECK((*image.find("B"))[i] == expected.z);
    CHECK((*image.find("A"))[i] == 1);
  }
  CHECK((*image.find("steps"))[3] == 8);
}
