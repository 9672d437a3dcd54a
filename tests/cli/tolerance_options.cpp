#include "levelray/core/error.hpp"
#include "support/catch.hpp"
#include "support/mesh_files.hpp"
#include "support/read_output.hpp"
#include "support/run_program.hpp"
#include "support/temporary_folder.hpp"
#include "tolerance.hpp"

#include <set>

using namespace levelray::test;

namespace {

using Strings = std::vector<std::string>;

Strings with(Strings arguments, const Strings& more) {
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

Json json_of(const Strings& arguments) {
  const RunResult result = run_program(with(arguments, {"--json", "-"}));
  INFO(result.err);
  REQUIRE(result.code == 0);
  return Json::parse(result.out);
}

} // namespace

TEST_CASE("tolerances are lengths, voxels or pixels") {
  using levelray::parse_tolerance;
  CHECK(parse_tolerance("0.25px").pixels);
  CHECK(parse_tolerance("0.25px").value == 0.25);
  CHECK(parse_tolerance("0.25px").unit() == "px");
  CHECK(parse_tolerance("0.1vx").length.unit == levelray::Length::Unit::voxels);
  CHECK(parse_tolerance("0.05mm").unit() == "mm");
  CHECK(parse_tolerance("1e-3").unit().empty());
  for (const char* bad : {"", "px", "0px", "-1px", "1 px", "1pixel", "0", "nan", "1e999"}) {
    CAPTURE(bad);
    CHECK_THROWS_AS(parse_tolerance(bad), levelray::Error);
  }
}

TEST_CASE("convert to a tolerance says what it chose, what it achieved and how to trace it") {
  const TemporaryFolder folder;
  write_text(folder / "ball.obj", ball_obj(24));
  const RunResult result = run_program({"convert", folder / "ball.obj", folder / "ball.vdb", "--units", "cm",
                                        "--tolerance", "0.2mm", "--json", folder / "report.json"});
  INFO(result.err);
  REQUIRE(result.code == 0);
  CHECK(result.err.empty());
  CHECK_THAT(result.out, Catch::Contains("tolerance 0.2mm: voxel ") && Catch::Contains("; achieved 0.1") &&
                             Catch::Contains("mm at p99.9, ") && Catch::Contains("mm at most, on ") &&
                             Catch::Contains("to trace it so: --intersector ") && Catch::Contains("wrote "));
  const Json json = Json::parse(content_of(folder / "report.json"));
  const Json& tolerance = json["tolerance"];
  CHECK(keys(tolerance) == std::set<std::string>{"asked", "unit", "world", "chosen", "achieved", "tried"});
  CHECK(keys(tolerance["chosen"]) ==
        std::set<std::string>{"voxel_size", "storage", "intersector", "normals", "normals_median_degrees"});
  CHECK(keys(tolerance["achieved"]) ==
        std::set<std::string>{"share", "error", "max", "demonstrated", "rays", "lost", "not_judged"});
  CHECK(tolerance["asked"] == "0.2mm");
  CHECK(tolerance["unit"] == "mm");
  CHECK(tolerance["world"].get<double>() == Approx(0.02));
  CHECK(tolerance["achieved"]["error"].get<double>() <= 0.02);
  CHECK(tolerance["achieved"]["rays"].get<int>() >= 19000);
  CHECK(tolerance["chosen"]["voxel_size"] == json["grid"]["voxel_size"]);
  REQUIRE(tolerance["tried"].size() >= 2);
  CHECK(keys(tolerance["tried"][0]) ==
        std::set<std::string>{"voxel_size", "storage", "intersector", "tolerance", "demonstrated"});
}

TEST_CASE("explicit options win over the tolerance's choices") {
  const TemporaryFolder folder;
  write_text(folder / "ball.obj", ball_obj(16));
  const Strings convert{"convert", folder / "ball.obj", folder / "ball.vdb", "--tolerance", "0.05"};
  CHECK(json_of(with(convert, {"--voxel", "0.04"}))["tolerance"]["chosen"]["voxel_size"] == 0.04);
  CHECK(json_of(with(convert, {"--resolution", "80"}))["tolerance"]["tried"].front()["voxel_size"] == 0.025);
  CHECK(json_of(convert)["tolerance"]["chosen"]["storage"] == "half");
  CHECK(json_of(with(convert, {"--half=false"}))["tolerance"]["chosen"]["storage"] == "float");
  CHECK(json_of(with(convert, {"--half"}))["tolerance"]["chosen"]["storage"] == "half");
  const Json render = json_of({"render", folder / "ball.obj", "-o", folder / "ball.png", "--size", "32x32",
                               "--tolerance", "0.05", "--intersector", "newton", "--normals", "dual-voxel"});
  CHECK(render["tolerance"]["chosen"]["intersector"] == "newton");
  CHECK(render["tolerance"]["chosen"]["normals"] == "dual-voxel");
  CHECK(render["options"]["intersector"] == "newton");
}

TEST_CASE("the picture is made with what the tolerance chose") {
  const TemporaryFolder folder;
  write_text(folder / "ball.obj", ball_obj(16));
  const Strings render{"render", folder / "ball.obj", "--size", "48x32"};
  const Json chosen = json_of(with(render, {"-o", folder / "a.png", "--tolerance", "0.02"}));
  CHECK(chosen["options"]["intersector"] == chosen["tolerance"]["chosen"]["intersector"]);
  CHECK(chosen["options"]["normals"] == chosen["tolerance"]["chosen"]["normals"]);
  const Json& c = chosen["tolerance"]["chosen"];
  CHECK(c["storage"] == "float"); // nothing is stored
  const std::string voxel = c["voxel_size"].dump();
  json_of(with(render, {"-o", folder / "b.png", "--voxel", voxel, "--intersector", c["intersector"],
                        "--normals", c["normals"]}));
  CHECK(content_of(folder / "a.png") == content_of(folder / "b.png"));
}

TEST_CASE("a tolerance in pixels is one in lengths at the nearest place of the picture") {
  const TemporaryFolder folder;
  write_text(folder / "ball.obj", ball_obj(24)); // of radius 1 at the origin
  const Strings render{"render",   folder / "ball.obj",
                       "-o",       folder / "ball.png",
                       "--eye",    "0,0,5",
                       "--target", "0,0,0",
                       "--fov",    "40",
                       "--size",   "300x200"};
  const Json json = json_of(with(render, {"--tolerance", "0.5px"}));
  // The nearest place is the pole, 4 away: 2 tan(20 degrees) * 4 / 200 a pixel. 4096 rays, a tenth of which
  // meet the ball, find it to a hundredth.
  const double pixel = 2 * std::tan(20 * 3.14159265358979 / 180) * 4 / 200;
  CHECK(json["tolerance"]["world"].get<double>() == Approx(0.5 * pixel).epsilon(0.02));
  CHECK(json["tolerance"]["unit"] == "px");
  CHECK(json["tolerance"]["achieved"]["error"].get<double>() <= 0.5 * pixel * 1.02);

  const RunResult convert =
      run_program({"convert", folder / "ball.obj", folder / "ball.vdb", "--tolerance", "0.5px"});
  CHECK(convert.code == 2);
  CHECK_THAT(convert.err, Catch::Contains("--tolerance 0.5px") && Catch::Contains("camera"));
  CHECK(folder.names() == Strings{"ball.obj", "ball.png"});
}

TEST_CASE("of a .vdb the tolerance is against its own surface, and chooses the intersector") {
  const TemporaryFolder folder;
  write_text(folder / "ball.obj", ball_obj(16));
  json_of({"convert", folder / "ball.obj", folder / "ball.vdb", "--resolution", "40"});
  const Strings render{"render", folder / "ball.vdb", "-o", folder / "ball.png", "--size", "32x32"};
  CHECK(json_of(with(render, {"--tolerance", "2vx"}))["options"]["intersector"] == "midpoint");
  const Json fine = json_of(with(render, {"--tolerance", "0.0001vx"}));
  CHECK(fine["options"]["intersector"] != "midpoint");
  CHECK(fine["tolerance"]["chosen"]["voxel_size"] == 0.05);
  const RunResult refused =
      run_program(with(render, {"--tolerance", "0.0001vx", "--intersector", "midpoint"}));
  CHECK(refused.code == 5);
  CHECK_THAT(refused.err,
             Catch::Contains("cannot be met with") && Catch::Contains("closest that can be met is"));
}

TEST_CASE("a tolerance that cannot be met is refused with the closest that can, and nothing is written") {
  const TemporaryFolder folder;
  write_text(folder / "box.obj", box_obj(3.1, 2.1, 1.1));
  const Strings convert{"convert", folder / "box.obj", folder / "box.vdb"};
  const auto closest_of = [](const RunResult& result) {
    const std::string mark = "closest that can be met is ";
    const std::size_t at = result.err.find(mark);
    REQUIRE(at != std::string::npos);
    const std::size_t from = at + mark.size();
    return result.err.substr(from, result.err.find_first_of(",\n", from) - from);
  };
  const RunResult fixed = run_program(with(convert, {"--tolerance", "0.01vx"}));
  INFO(fixed.err);
  CHECK(fixed.code == 5);
  CHECK(fixed.err.size() <= 500);
  CHECK(folder.names() == Strings{"box.obj"});
  CHECK(run_program(with(convert, {"--tolerance", closest_of(fixed)})).code == 0);

  const RunResult limited = run_program(with(convert, {"--tolerance", "1e-4", "--max-memory", "4MiB"}));
  INFO(limited.err);
  CHECK(limited.code == 5);
  CHECK_THAT(limited.err, Catch::Contains("--max-memory"));
  CHECK(run_program(with(convert, {"--tolerance", closest_of(limited), "--max-memory", "4MiB"})).code == 0);

  const RunResult units = run_program(with(convert, {"--tolerance", "1mm"}));
  CHECK(units.code == 2);
  CHECK_THAT(units.err, Catch::Contains("--tolerance") && Catch::Contains("--units"));
  CHECK(run_program(with(convert, {"--tolerance", "nonsense"})).code == 2);
  CHECK(run_program(with(convert, {"--tolerance", "1%", "--sign", "unsigned"})).code == 2);
}

TEST_CASE("the same file comes out for any number of threads") {
  const TemporaryFolder folder;
  write_text(folder / "ball.obj", ball_obj(16));
  for (const char* threads : {"1", "2", "7"})
    REQUIRE(run_program({"convert", folder / "ball.obj", folder / (std::string(threads) + ".vdb"),
                         "--tolerance", "0.5%", "-j", threads})
                .code == 0);
  CHECK(content_of(folder / "1.vdb") == content_of(folder / "2.vdb"));
  CHECK(content_of(folder / "1.vdb") == content_of(folder / "7.vdb"));
}
