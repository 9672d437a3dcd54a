#include "names.hpp"

#include "levelray/core/error.hpp"
#include "support/catch.hpp"

using namespace levelray;

TEST_CASE("the nearest name is suggested when it is near enough to be meant") {
  const std::vector<std::string> names{"auto", "pseudonormal", "winding", "winding-abs"};
  CHECK(nearest_name("autp", names) == "auto");
  CHECK(nearest_name("wnding", names) == "winding");
  CHECK(nearest_name("winding_abs", names) == "winding-abs");
  CHECK(nearest_name("psuedonormal", names) == "pseudonormal");
  CHECK(nearest_name("flood", names).empty());
  CHECK(nearest_name("", names).empty());
  CHECK(nearest_name(std::string(100000, 'a'), names).empty());
}

TEST_CASE("an unknown name is refused with the legal ones") {
  const std::vector<std::string> names{"lambert", "phong"};
  CHECK(find_name("--shading", "phong", names) == 1);
  try {
    find_name("--shading", "fong", names);
    FAIL("accepted");
  } catch (const Error& error) {
    CHECK(error.kind() == ErrorKind::usage);
    CHECK(std::string(error.what()) == "--shading \"fong\" is unknown; choose from lambert, phong");
  }
}

TEST_CASE("lists are split at commas, empty pieces kept") {
  CHECK(split_list("t,P,N") == std::vector<std::string>{"t", "P", "N"});
  CHECK(split_list("t") == std::vector<std::string>{"t"});
  CHECK(split_list("t,") == std::vector<std::string>{"t", ""});
}
