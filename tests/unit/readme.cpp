#include "support/catch.hpp"

#include "levelray/intersect/intersectors.hpp"
#include "levelray/normal/normals.hpp"

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>

using namespace levelray;

namespace {

// Rows of one family of methods, from its list.
template <class List>
std::string rows(const std::string& option) {
  std::string text;
  for (const std::string& name : method_names<List>())
    visit_method<List>(name, [&](auto method) {
      text += "| `" + option + " " + name + "` | " + std::string(decltype(method)::source) + " |\n";
    });
  return text;
}

std::string methods_table() {
  return "\n| option | source |\n|---|---|\n" + rows<Intersectors>("--intersector") +
         rows<NormalSchemes>("--normals") + "\n";
}

} // namespace

// With LEVELRAY_UPDATE_README set it writes the table instead of comparing (target `readme`).
TEST_CASE("the README's table of methods is the one in the code") {
  const std::string path = LEVELRAY_SOURCE_DIR "/README.md";
  std::ifstream file(path);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  const std::string end_mark = "<!-- end of methods -->";
  const std::size_t mark = text.find("<!-- methods:");
  REQUIRE(mark != std::string::npos);
  const std::size_t begin = text.find('\n', mark) + 1;
  const std::size_t end = text.find(end_mark, begin);
  REQUIRE(end != std::string::npos);

  if (std::getenv("LEVELRAY_UPDATE_README")) {
    std::ofstream(path) << text.substr(0, begin) + methods_table() + text.substr(end);
    WARN("wrote the table of methods into " << path);
  } else
    CHECK(text.substr(begin, end - begin) == methods_table());
}
