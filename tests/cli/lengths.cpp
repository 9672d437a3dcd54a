#include "lengths.hpp"

#include "levelray/core/error.hpp"
#include "support/catch.hpp"

using namespace levelray;

namespace {

// The message of the Error(usage) that `work` throws; "" when it throws none.
template <class Work>
std::string usage_error(Work&& work) {
  try {
    work();
  } catch (const Error& error) {
    CHECK(error.kind() == ErrorKind::usage);
    return error.what();
  }
  return "";
}

double length(const std::string& text, const LengthScale& scale) {
  return resolve_length("--voxel", parse_length("--voxel", text), scale);
}

} // namespace

TEST_CASE("a length without a unit is in the input's own") {
  CHECK(length("2e-3", {}) == 2e-3);
  CHECK(length("+0.5", {}) == 0.5);
  CHECK(length("7", {Length::Unit::inches, 0, 0}) == 7);
}

TEST_CASE("lengths with units are turned into the input's") {
  const LengthScale millimetres{Length::Unit::millimetres, 100, 0.25};
  CHECK(length("0.5mm", millimetres) == 0.5);
  CHECK(length("0.5cm", millimetres) == Approx(5).epsilon(1e-15));
  CHECK(length("2in", millimetres) == Approx(50.8).epsilon(1e-15));
  CHECK(length("1m", millimetres) == Approx(1000).epsilon(1e-15));
  CHECK(length("0.5%", millimetres) == 0.5);
  CHECK(length("3vx", millimetres) == 0.75);
  CHECK(length("1in", {Length::Unit::inches, 0, 0}) == 1);
  CHECK(length("1mm", {Length::Unit::metres, 0, 0}) == 1e-3);
}

TEST_CASE("lengths that cannot be meant are refused with the option's name") {
  for (const char* text :
       {"", "mm", "1 mm", "1km", "0,5", "0.5mmm", "nan", "inf", "1e400", "0x10", "1e", "--voxel"})
    CHECK_THAT(usage_error([&] { parse_length("--voxel", text); }), Catch::Contains("--voxel"));
  CHECK_THAT(usage_error([&] { parse_length("--voxel", "0"); }), Catch::Contains("must be > 0"));
  CHECK_THAT(usage_error([&] { parse_length("--voxel", "-1mm"); }), Catch::Contains("must be > 0"));
  CHECK_THAT(usage_error([&] { length("1mm", {}); }), Catch::Contains("--units"));
  CHECK_THAT(usage_error([&] { length("1vx", {}); }), Catch::Contains("voxels"));
  CHECK_THAT(usage_error([&] { parse_unit("ft"); }), Catch::Contains("mm, cm, m or in"));
  CHECK_THAT(usage_error([&] { parse_unit("%"); }), Catch::Contains("mm, cm, m or in"));
}

TEST_CASE("sizes in bytes know powers of 1000 and of 1024") {
  CHECK(parse_bytes("--max-memory", "123") == 123);
  CHECK(parse_bytes("--max-memory", "5B") == 5);
  CHECK(parse_bytes("--max-memory", "2kB") == 2000);
  CHECK(parse_bytes("--max-memory", "1.5MB") == 1500000);
  CHECK(parse_bytes("--max-memory", "8GiB") == std::uint64_t{8} << 30);
  CHECK(parse_bytes("--max-memory", "1KiB") == 1024);
  CHECK(parse_bytes("--max-memory", "1TiB") == std::uint64_t{1} << 40);
  CHECK(parse_bytes("--max-memory", "0") == 0);
  for (const char* text : {"", "8G", "8GB ", "-1", "1e30", "many", "1iB"})
    CHECK_THAT(usage_error([&] { parse_bytes("--max-memory", text); }), Catch::Contains("--max-memory"));
}

TEST_CASE("vectors are three numbers with commas") {
  CHECK(parse_vector("--eye", "1,-2.5,3e2") == Vec3d(1, -2.5, 300));
  for (const char* text : {"", "1,2", "1,2,3,4", "1, 2,3", "1,2,3 ", "a,b,c", "1,2,nan", "1;2;3"})
    CHECK_THAT(usage_error([&] { parse_vector("--eye", text); }), Catch::Contains("--eye"));
}
