#include "levelray/io/number_text.hpp"

#include "support/catch.hpp"

#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <limits>
#include <random>
#include <string>

using namespace levelray;

namespace {

struct Read {
  double value;
  std::size_t used; // 0: no number
};

Read read(const std::string& text) {
  const ParsedDouble number = parse_double(text.data(), text.data() + text.size());
  return {number.value, number.end == nullptr ? 0 : static_cast<std::size_t>(number.end - text.data())};
}

} // namespace

TEST_CASE("decimal numbers become the nearest double") {
  CHECK(read("0.1").value == 0.1);
  CHECK(read(".5").value == 0.5);
  CHECK(read("5.").value == 5.0);
  CHECK(read("+1.5e+2").value == 150.0);
  CHECK(read("-2E-3").value == -0.002);
  // Halfway between two doubles: to even, and one digit far behind decides.
  CHECK(read("9007199254740993").value == 9007199254740992.0);
  CHECK(read("9007199254740993.00000000000000000000000000000000000001").value == 9007199254740994.0);
  CHECK(read("2.2250738585072011e-308").value == 2.2250738585072011e-308);
  CHECK(read("1." + std::string(2000, '0') + "1").value == 1.0);
  const std::uint64_t seed = 20;
  std::mt19937_64 random(seed);
  CAPTURE(seed);
  for (int i = 0; i < 20000; ++i) {
    const std::uint64_t bits = random();
    double x;
    std::memcpy(&x, &bits, sizeof x);
    if (!std::isfinite(x)) continue;
    for (const std::string& text : {fmt::format("{}", x), fmt::format("{:.17e}", x)}) {
      const Read number = read(text);
      REQUIRE(number.used == text.size());
      REQUIRE(number.value == x);
    }
  }
}

TEST_CASE("numbers beyond the range become infinities and zeros of their sign") {
  const double infinity = std::numeric_limits<double>::infinity();
  CHECK(read("1e400").value == infinity);
  CHECK(read("-1e400").value == -infinity);
  CHECK(read("1" + std::string(400, '0')).value == infinity);
  CHECK(read("0." + std::string(400, '0') + "1e900").value == infinity);
  CHECK(read("1e99999999999999999999").value == infinity);
  CHECK(read("1e-400").value == 0);
  CHECK(read("0." + std::string(400, '0') + "1").value == 0);
  CHECK(read("1" + std::string(400, '0') + "e-900").value == 0);
  CHECK(std::signbit(read("-1e-99999999999999999999").value));
  CHECK(read("-0.0e99999").value == 0);
  CHECK(std::isnan(read("nan").value));
  CHECK(read("-inf").value == -infinity);
  for (const char* text : {"1.#INF", "-1.#IND", "1.#QNAN0"}) {
    CHECK(!std::isfinite(read(text).value));
    CHECK(read(text).used == std::strlen(text));
  }
}

TEST_CASE("what is no number is told, and what follows one is left") {
  for (const char* text : {"", "+", "-", ".", "e5", "+-1", "++1", "--1", "x", ",5", " 1"}) {
    CAPTURE(text);
    CHECK(read(text).used == 0);
  }
  CHECK(read("0,5").used == 1);
  CHECK(read("1e").used == 1);
  CHECK(read("0x10").used == 1);
  CHECK(read("1.5.5").used == 3);
}

TEST_CASE("integers saturate") {
  const auto integer = [](const std::string& text) {
    return parse_integer(text.data(), text.data() + text.size());
  };
  CHECK(integer("12").value == 12);
  CHECK(integer("-12").value == -12);
  CHECK(integer("+7").value == 7);
  CHECK(integer("9223372036854775807").value == 9223372036854775807);
  CHECK(integer("9223372036854775808").value == 9223372036854775807);
  CHECK(integer("-99999999999999999999999").value == -9223372036854775807);
  for (const char* text : {"", "-", "+", "+-1", "a", ".5"}) CHECK(integer(text).end == nullptr);
}
