// levelray measure --suite paper: its tables, its models, what it says without them.
#include "paper_models.hpp"
#include "support/catch.hpp"
#include "support/read_output.hpp"
#include "support/run_program.hpp"
#include "support/temporary_folder.hpp"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

using namespace levelray;
using namespace levelray::test;

namespace {

// A box with these sides, closed, of 12 triangles.
void write_box(const std::string& path, double x, double y, double z) {
  std::filesystem::create_directories(std::filesystem::path(path).parent_path());
  std::ofstream file(path);
  for (int c = 0; c < 8; ++c)
    file << "v " << (c & 1 ? x : 0) << " " << (c & 2 ? y : 0) << " " << (c & 4 ? z : 0) << "\n";
  file << "f 1 3 4\nf 1 4 2\nf 5 6 8\nf 5 8 7\nf 1 2 6\nf 1 6 5\nf 3 7 8\nf 3 8 4\nf 1 5 7\nf 1 7 3\nf 2 4 "
          "8\nf 2 8 6\n";
}

Json table(const Json& document, const std::string& id) {
  for (const Json& section : document["sections"])
    for (const Json& table : section["tables"])
      if (table["id"] == id) return table;
  FAIL("no table " << id);
  return {};
}

std::size_t column(const Json& table, const std::string& key) {
  for (std::size_t i = 0; i < table["columns"].size(); ++i)
    if (table["columns"][i]["key"] == key) return i;
  FAIL("no column " << key);
  return 0;
}

std::size_t quoted(const Json& table) {
  std::size_t n = 0;
  for (const Json& column : table["columns"]) n += column.value("quoted", false);
  return n;
}

RunResult measure(std::vector<std::string> more) {
  more.insert(more.begin(), {"measure", "--suite", "paper", "--json", "-"});
  return run_program(more);
}

} // namespace

TEST_CASE("measure has Tables 1 to 4 of the paper, of shapes of its own where there are no models") {
  const RunResult run = measure({"--resolution", "16,24", "--size", "48", "--repeat", "1"});
  INFO(run.err);
  REQUIRE(run.code == 0);
  const Json json = Json::parse(run.out);
  CHECK(json["failures"].empty());
  CHECK_THAT(json["findings"].dump(), Catch::Contains("substitutes"));
  CHECK(json["options"]["size"] == 48);
  for (const Json& section : json["sections"])
    for (const Json& each : section["tables"]) {
      INFO(each["id"]);
      REQUIRE(!each["rows"].empty());
      for (const Json& row : each["rows"]) CHECK(row.size() == each["columns"].size());
    }
  // Counts of Tables 1 and 2 depend on no picture, times do.
  const Json one = table(json, "table-1");
  CHECK(one["rows"][0] == Json({"#interpolations", 1.0, 2, 2.0, 2, 5.0, 5, one["rows"][0][7]}));
  CHECK(one["rows"][1][1].get<double>() > 0);
  CHECK(one["rows"][1][column(one, "midpoint_printed")].is_null());
  CHECK(one["columns"][1]["group"] == "midpoint");
  const Json two = table(json, "table-2");
  CHECK(two["rows"][0][column(two, "interpolation-of-differences_printed")] == 24);
  // Nothing printed is of these shapes.
  for (const char* id : {"table-3", "table-4"}) {
    const Json scenes = table(json, id);
    CHECK(quoted(scenes) == 0);
    CHECK(scenes["rows"][0].back().is_number());
    REQUIRE(scenes["rows"].size() == 4);
    CHECK(scenes["rows"][0][0] == "torus (substitute)");
    CHECK(scenes["rows"][3][1] == 24);
  }
  CHECK(table(json, "primary-ways")["rows"].size() == 4 * 8);
  const Json ways = table(json, "shadow-ways");
  CHECK(ways["rows"].size() == 4 * 8);
  for (const Json& row : ways["rows"]) CHECK(row[column(ways, "different")] == 0);
}

TEST_CASE("measure prints the paper's figures behind ours, under the paper's headings") {
  const RunResult run =
      run_program({"measure", "--suite", "paper", "--resolution", "16", "--size", "32", "--repeat", "0"});
  INFO(run.err);
  REQUIRE(run.code == 0);
  const std::string title = "Table 2: surface normals\n";
  const std::size_t at = run.out.find(title);
  REQUIRE(at != std::string::npos);
  std::istringstream lines(run.out.substr(at + title.size()));
  std::string groups, heads, samples;
  std::getline(lines, groups), std::getline(lines, heads), std::getline(lines, samples);
  INFO(groups << "\n" << heads << "\n" << samples);
  for (const char* group :
       {"analytic derivative", "difference of interpolations", "interpolation of differences"}) {
    const std::size_t place = groups.find(group);
    REQUIRE(place != std::string::npos);
    CHECK(heads.compare(place, 4, "ours") == 0);
  }
  std::istringstream words(samples);
  const std::vector<std::string> found{std::istream_iterator<std::string>(words), {}};
  CHECK(found == std::vector<std::string>{"#samples", "8", "8", "20", "16", "32", "24"});
}

TEST_CASE("measure puts the paper's figures beside those of models, and says where missing ones are") {
  const TemporaryFolder folder;
  write_box(folder / "bunny/reconstruction/bun_zipper.ply.txt", 1, 1, 1); // not a mesh by its name
  write_box(folder / "models/Stanford_Bunny.obj", 1, 1, 0.8);
  write_box(folder / "models/happy-buddha-2k.obj", 0.43, 0.43, 1); // z up
  const RunResult run =
      measure({"--models", folder.path(), "--resolution", "128,40", "--size", "512", "--repeat", "0"});
  INFO(run.err);
  REQUIRE(run.code == 0);
  const Json json = Json::parse(run.out);
  CHECK(json["failures"].empty());
  CHECK_THAT(json["findings"].dump(), Catch::Contains("dragon is missing") && Catch::Contains("3Dscanrep"));

  const Json three = table(json, "table-3"), four = table(json, "table-4");
  CHECK(quoted(three) == 1 + 2 + 3 * 3);
  CHECK(quoted(four) == 1 + 3 + 2 * 4);
  REQUIRE(three["rows"].size() == 6); // three models, two resolutions
  const Json &bunny = three["rows"][0], &coarse = three["rows"][1], &dragon = three["rows"][2],
             &buddha = three["rows"][4];
  CHECK(bunny[0] == "bunny");
  CHECK(bunny[2] == "128x128x102");
  CHECK(bunny[3] == "128x128x100");
  CHECK(bunny[column(three, "steps_printed")] == 5733);
  CHECK(bunny[column(three, "steps")].get<int>() > 100); // thousands, of 262,144 rays
  CHECK(bunny[column(three, "saved_64_printed")] == 19);
  CHECK(bunny[column(three, "saved_64")].is_null());       // nothing was timed
  CHECK(coarse[column(three, "steps_printed")].is_null()); // the paper has no such row
  CHECK(coarse[column(three, "steps")].get<int>() > 100);
  CHECK(dragon[2] == "missing");
  CHECK(dragon[column(three, "steps")].is_null());
  CHECK(dragon[column(three, "steps_printed")] == 4264);
  CHECK(buddha[2] == "55x128x55");
  CHECK(four["rows"][0][column(four, "tests_32_printed")] == 320);
  CHECK(four["rows"][0][column(four, "saved_12_printed")] == 10.5);
  const Json one = table(json, "table-1");
  CHECK(one["rows"][1][column(one, "false-position-4_printed")] == 11.2);

  const Json models = table(json, "models");
  CHECK(models["rows"][0][column(models, "file")] == folder / "models/Stanford_Bunny.obj");
  CHECK(models["rows"][1][column(models, "file")] == "missing");
  CHECK(models["rows"][2][column(models, "turned")] == "z up to y up");
  std::size_t scenes = 0; // claims of Table 3, about steps, are of the two rows that can be compared
  const Json trends = table(json, "trends");
  for (const Json& row : trends["rows"])
    if (row[0] == 3) {
      ++scenes;
      CHECK_THAT(row[column(trends, "ours")].get<std::string>(), Catch::Contains("of 6"));
    }
  CHECK(scenes == 2);
}

TEST_CASE("measure refuses folders without any of the paper's models") {
  const TemporaryFolder folder;
  write_box(folder / "teapot.obj", 1, 1, 1);
  const RunResult none = measure({"--models", folder.path()});
  CHECK(none.code == 3);
  CHECK_THAT(none.err, Catch::Contains("no bunny, dragon, buddha there") && Catch::Contains("3Dscanrep"));
  const RunResult nowhere = measure({"--models", folder / "nowhere"});
  CHECK(nowhere.code == 3);
  CHECK_THAT(nowhere.err, Catch::Contains("no such folder"));
  std::ofstream(folder / "dragon.ply") << "not a mesh";
  const RunResult broken = measure({"--models", folder.path(), "--resolution", "16", "--size", "32"});
  CHECK(broken.code == 3);
  CHECK_THAT(broken.err, Catch::Contains("dragon.ply"));
}

TEST_CASE("models are known by the names under which they are passed around") {
  for (const char* name : {"bun_zipper.ply", "bun_zipper_res3.ply", "bunny.obj", "Bunny.STL",
                           "stanford-bunny.obj", "stanford_bunny_closed.ply", "bunny00.off"}) {
    CAPTURE(name);
    CHECK(model_rank("bunny", name) >= 0);
    CHECK(model_rank("dragon", name) == -1);
  }
  for (const char* name :
       {"dragon_vrip.ply", "dragon_vrip_res2.ply", "dragon.obj", "stanford-dragon-80k-closed.obj"}) {
    CAPTURE(name);
    CHECK(model_rank("dragon", name) >= 0);
  }
  for (const char* name :
       {"happy_vrip.ply", "buddha.obj", "happy-buddha-100k.obj", "HappyBuddha.off", "happy_buddha.ply"}) {
    CAPTURE(name);
    CHECK(model_rank("buddha", name) >= 0);
  }
  // Another dragon, other things, no meshes.
  for (const char* name :
       {"xyzrgb_dragon.ply", "dragonfly.obj", "dragon_vrip.ply.gz", "dragon.png", "dragon", ""}) {
    CAPTURE(name);
    CHECK(model_rank("dragon", name) == -1);
  }
  const TemporaryFolder folder;
  for (const char* name : {"a/bunny.obj", "b/stanford-bunny.obj", "c/d/stanford-bunny-closed.obj",
                           "buddha.obj", "happy-buddha-100k-nonmanifold.obj", "e/happy-buddha-100k.obj",
                           "dragon_vrip_res4.ply", "dragon_vrip_res2.ply", "dragon.obj"})
    write_box(folder / name, 1, 1, 1);
  const std::vector<PaperModel> models = find_paper_models(folder.path());
  REQUIRE(models.size() == 3);
  CHECK(models[0].path == folder / "c/d/stanford-bunny-closed.obj");
  CHECK(models[1].path == folder / "dragon_vrip_res2.ply");
  CHECK(models[2].path == folder / "e/happy-buddha-100k.obj");
}
