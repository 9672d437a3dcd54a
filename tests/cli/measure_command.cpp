// levelray measure: documents, pages, exit codes.
#include "support/catch.hpp"
#include "support/read_output.hpp"
#include "support/run_program.hpp"
#include "support/temporary_folder.hpp"

#include <filesystem>
#include <fstream>
#include <iterator>

using namespace levelray::test;

namespace {

const std::vector<std::string> small{"measure",  "--suite",     "analytic", "--resolution", "12,20",
                                     "--shapes", "sphere,slab", "--rays",   "300",          "--repeat",
                                     "1"};

RunResult measure(std::vector<std::string> more) {
  more.insert(more.begin(), small.begin(), small.end());
  return run_program(more);
}

std::string content(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

} // namespace

TEST_CASE("measure prints tables, and writes all of it as JSON and as a page") {
  const TemporaryFolder folder;
  const RunResult run = measure({"--json", folder / "m.json", "--report", folder / "m.html"});
  INFO(run.err);
  REQUIRE(run.code == 0);
  CHECK_THAT(run.out, Catch::Contains("Hits of intersectors") && Catch::Contains("false-position-4") &&
                          Catch::Contains("Slopes of log(error)"));
  const Json json = Json::parse(content(folder / "m.json"));
  CHECK(json["suite"] == "analytic");
  CHECK_THAT(json["command"].get<std::string>(),
             Catch::Contains("measure --suite analytic --resolution 12,20"));
  CHECK(json["machine"]["hardware_threads"].get<int>() > 0);
  CHECK(json["options"]["seed"] == 1);
  CHECK(json["options"]["resolution"] == Json({12, 20}));
  CHECK(json["failures"].empty());
  std::size_t tables = 0, plots = 0;
  for (const Json& section : json["sections"]) {
    plots += section["plots"].size();
    for (const Json& table : section["tables"]) {
      ++tables;
      REQUIRE(!table["rows"].empty());
      for (const Json& row : table["rows"]) CHECK(row.size() == table["columns"].size());
    }
  }
  CHECK(tables == 5);
  CHECK(plots == 2 * 2);

  const std::string page = content(folder / "m.html");
  const std::string begin = "<script type=\"application/json\" id=\"data\">";
  const std::size_t at = page.find(begin);
  REQUIRE(at != std::string::npos);
  const std::size_t end = page.find("</script>", at);
  CHECK(Json::parse(page.substr(at + begin.size(), end - at - begin.size())) == json);
  CHECK(page.find("{{") == std::string::npos);
  // Nothing to load from anywhere; the one address is the name of SVG.
  for (std::size_t i = page.find("http"); i != std::string::npos; i = page.find("http", i + 1))
    CHECK((page.compare(i, 26, "http://www.w3.org/2000/svg") == 0 || page.compare(i, 10, "http-equiv") == 0));
  CHECK(page.find("src=") == std::string::npos);
}

TEST_CASE("measure gives JSON alone on standard output, and the same numbers again but for times") {
  const auto numbers = [](const RunResult& run) {
    Json json = Json::parse(run.out);
    for (const char* key : {"seconds", "machine", "command"}) json.erase(key);
    for (Json& section : json["sections"])
      for (Json& table : section["tables"])
        for (std::size_t c = 0; c < table["columns"].size(); ++c)
          if (table["columns"][c]["key"].get<std::string>().find("ns") != std::string::npos)
            for (Json& row : table["rows"]) row[c] = 0;
    return json;
  };
  const RunResult first = measure({"--json", "-"}), again = measure({"--json", "-", "-j", "1"});
  REQUIRE(first.code == 0);
  CHECK(numbers(first) == numbers(again));
  CHECK(numbers(measure({"--json", "-", "--seed", "2"})) != numbers(first));
}

TEST_CASE("measure says what was wrong with its options, and leaves no files then") {
  const TemporaryFolder folder;
  const auto refused = [](const std::vector<std::string>& arguments, const std::string& text) {
    const RunResult run = run_program(arguments);
    CHECK(run.code == 2);
    CHECK_THAT(run.err, Catch::Contains(text));
  };
  refused({"measure"}, "measure takes a mesh, a .vdb or --suite: analytic");
  refused({"measure", "--suite", "analitic"}, "analytic");
  refused({"measure", "--suite", "analytic", "--shapes", "cube"},
          "unknown shape 'cube'; there are sphere, torus");
  refused({"measure", "--suite", "analytic", "--resolution", "32,x"},
          "--resolution \"32,x\": must be whole numbers");
  refused({"measure", "--suite", "analytic", "--resolution", "4"}, "from 8 to 4096");
  refused({"measure", "--suite", "analytic", "--band", "3mm"}, "--band \"3mm\": must be 1vx to 64vx");
  refused({"measure", "--suite", "analytic", "--report", folder / "m.txt"}, ".html");
  CHECK(std::filesystem::is_empty(folder.path()));
}

TEST_CASE("measure runs OpenVDB's tracer and converter beside ours") {
  const RunResult run = run_program({"measure", "--suite", "openvdb", "--resolution", "16,24", "--shapes",
                                     "sphere,slab", "--rays", "300", "--repeat", "1", "--json", "-"});
  INFO(run.err);
  REQUIRE(run.code == 0);
  const Json json = Json::parse(run.out);
  CHECK(json["failures"].empty());
  std::vector<std::string> titles;
  for (const Json& section : json["sections"])
    for (const Json& table : section["tables"]) {
      titles.push_back(table["id"]);
      std::size_t theirs = 0;
      for (const Json& row : table["rows"]) theirs += row[2] == "OpenVDB";
      CHECK(theirs == (table["id"] == "converters" ? 2 : 4)); // of two shapes one is a box
    }
  CHECK(titles == std::vector<std::string>{"tracers", "tracers-grid", "converters"});
}

TEST_CASE("measure tells of a mesh how far its level sets are from it, and what the trade is") {
  const TemporaryFolder folder;
  // A box of 2 x 1 x 0.1.
  std::ofstream(folder / "plate.obj")
      << "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 0 1 0\nv 0 0 .1\nv 2 0 .1\nv 2 1 .1\nv 0 1 .1\n"
         "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
  const RunResult run = run_program({"measure", folder / "plate.obj", "--resolution", "24,160", "--rays",
                                     "1000", "--repeat", "1", "--json", "-", "--report", folder / "m.html"});
  INFO(run.err);
  REQUIRE(run.code == 0);
  const Json json = Json::parse(run.out);
  CHECK(json["mesh"]["closed"] == true);
  // Rays from its two large faces meet the other one 0.1 away; those from its rim, 0.6 of 4.6, meet 1 or 2.
  CHECK(json["thickness"]["p50"].get<double>() == Approx(0.1).margin(1e-9));
  CHECK(json["thickness"]["p1"].get<double>() == Approx(0.1).margin(1e-9));
  // Voxels of 1/12 and 1/80: 1.2 and 8 of them across.
  CHECK(json["thickness"]["thin_share"][0].get<double>() == Approx(4 / 4.6).margin(0.02));
  CHECK(json["thickness"]["thin_share"][1].get<double>() < 0.01);
  CHECK_THAT(json["findings"].dump(), Catch::Contains("at 24: ") &&
                                          Catch::Contains("thinner than 2 voxels") &&
                                          Catch::Contains("--voxel 0.05"));
  const Json& surface = json["sections"][1]["tables"][0];
  REQUIRE(surface["rows"].size() == 2);
  for (const Json& row : surface["rows"]) {
    CHECK(row[4].get<double>() < 0.87); // interpolation moves the surface by sqrt(3)/2 voxels at the most
    CHECK(row[10].get<int>() > 300);    // signs looked at
    CHECK(row[11] == 0);                // and wrong
    CHECK(row[12] == 1000);             // rays whose first place on the mesh is bracketed
    CHECK(row[14] == 0);                // wrongly
  }
  bool front = false;
  for (const Json& row : json["sections"][0]["tables"][0]["rows"]) {
    front = front || row[2] == "yes";
    if (row[1] == "exact") CHECK(row[7] == 0);
  }
  CHECK(front);

  const RunResult both = run_program({"measure", folder / "plate.obj", "--suite", "analytic"});
  CHECK(both.code == 2);
  const RunResult missing = run_program({"measure", folder / "none.obj"});
  CHECK(missing.code == 3);
}

TEST_CASE("measure tells of a level set what is proven about hits, how thin it is, and what the trade is") {
  const TemporaryFolder folder;
  // A box of 2 x 1 x 0.1, in voxels of 1/80: 8 of them thick, and its faces are flat to rounding.
  std::ofstream(folder / "plate.obj")
      << "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 0 1 0\nv 0 0 .1\nv 2 0 .1\nv 2 1 .1\nv 0 1 .1\n"
         "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
  REQUIRE(run_program({"convert", folder / "plate.obj", folder / "plate.vdb", "--voxel", "0.0125"}).code ==
          0);
  const RunResult run = run_program({"measure", folder / "plate.vdb", "--rays", "2000", "--repeat", "1",
                                     "--json", "-", "--report", folder / "m.html"});
  INFO(run.err);
  REQUIRE(run.code == 0);
  const Json json = Json::parse(run.out);
  CHECK(json["suite"] == "grid");
  CHECK(json["field"]["is_distance"] == true);
  CHECK(json["grid"]["voxel_size"].get<double>() == 0.0125);
  CHECK(json["failures"].empty());
  // Samples are floats, so faces are where they should be within 2^-24 of the band.
  CHECK(json["thickness"]["p50"].get<double>() == Approx(0.1).margin(1e-7));
  CHECK(json["thickness"]["thin_share"][0].get<double>() < 0.02);
  const Json& proofs = json["sections"][1]["tables"][0]["rows"][0];
  CHECK(proofs[0] == 2000);
  CHECK(proofs[1].get<int>() > 100);     // hits
  CHECK(proofs[2] == proofs[1]);         // all of them proven crossings
  CHECK(proofs[7].get<double>() < 1e-7); // with bounds, in voxels
  const Json& hits = json["sections"][0]["tables"][0];
  CHECK(hits["columns"][0]["key"] == "method");
  CHECK(hits["rows"][0][0] == "exact");
  CHECK(hits["rows"][0][5].get<double>() < 1e-12); // the interpolant's size at the worst of exact hits
  CHECK(hits["rows"][0][6] == 0);

  const RunResult thin = run_program({"measure", folder / "plate.vdb", "--resolution", "64"});
  CHECK(thin.code == 2);
  CHECK_THAT(thin.err, Catch::Contains("--resolution is for meshes"));
}
