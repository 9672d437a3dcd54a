#include "levelray/measure/interleaved_times.hpp"
#include "levelray/measure/paper_trends.hpp"
#include "levelray/measure/study_scene.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

using namespace levelray;

namespace {

const PaperMethod& named(const std::vector<PaperMethod>& methods, const std::string& name) {
  return *std::find_if(methods.begin(), methods.end(),
                       [&](const PaperMethod& m) { return m.method == name; });
}

const Reference& ball() {
  static const std::vector<Reference> all = all_references();
  return all.front();
}

PaperSettings tiny() {
  PaperSettings settings;
  settings.image_size = 48, settings.repetitions = 1;
  return settings;
}

const auto silent = [](double) {};

// A row whose ways have those parts of the printed figures.
PaperRow row_like(const PrintedRow& printed, double steps, double time) {
  PaperRow row;
  row.model = printed.model, row.resolution = printed.resolution;
  row.scene.emplace();
  for (std::size_t i = 0; i < 4; ++i) {
    PaperWay way;
    way.counts.steps = static_cast<std::uint64_t>(1e6 * (i ? 1 - steps : 1));
    way.saved = i ? time : 0;
    row.scene->primary.push_back(way);
    way.counts.tests = way.counts.steps;
    row.scene->shadow.push_back(way);
  }
  return row;
}

const PaperTrend& about(const std::vector<PaperTrend>& trends, int table, const std::string& word) {
  const auto at = std::find_if(trends.begin(), trends.end(), [&](const PaperTrend& t) {
    return t.table == table && t.claim.find(word) != std::string::npos;
  });
  REQUIRE(at != trends.end());
  return *at;
}

} // namespace

TEST_CASE("what the paper prints as saved follows from its times, so the figures are copied right") {
  // Times are rounded to 0.05 ms, which moves the part saved, 1 - b/a, by up to 0.05/a (1 + b/a); the printed
  // part is rounded to 0.5 % (Table 3) or 0.05 % (Table 4).
  const auto near = [](double before, double now, double printed, double rounding) {
    INFO(before << " " << now << " " << printed);
    const double part = 1 - now / before;
    CHECK(std::fabs(100 * part - printed) <= rounding + 100 * 0.05 / before * (1 + now / before) + 1e-9);
  };
  for (const PrintedRow& row : printed_rows) {
    INFO(row.model << " " << row.resolution);
    CHECK(*std::max_element(std::begin(row.voxels), std::end(row.voxels)) == row.resolution);
    for (std::size_t i = 1; i < 4; ++i)
      near(row.primary_ms[0], row.primary_ms[i], row.primary_saved[i - 1], 0.5);
    for (std::size_t i = 1; i < 3; ++i)
      near(row.shadow_ms[0], row.shadow_ms[i], row.shadow_saved[i - 1], 0.05);
    // Smaller buffers, or a longer look ahead, take more steps; tests only fall.
    for (std::size_t i = 2; i < 4; ++i) CHECK(row.primary_steps[i] > row.primary_steps[i - 1]);
    for (std::size_t i = 1; i < 3; ++i) CHECK(row.shadow_steps[i] > row.shadow_steps[i - 1]);
    for (std::size_t i = 1; i < 3; ++i) CHECK(row.shadow_tests[i] <= row.shadow_tests[i - 1]);
    CHECK(printed_row(row.model, row.resolution) == &row);
  }
  CHECK(std::size(printed_rows) == 9);
  CHECK(printed_row("bunny", 64) == nullptr);
  CHECK(printed_row("hare", 128) == nullptr);
}

TEST_CASE("ratios of times are medians of those within repetitions") {
  TimeSpread a, b;
  a.each = {2, 30, 8}, b.each = {1, 10, 8}; // ratios 2, 3, 1; of the medians it would be 8 / 8
  CHECK(median_ratio(a, b) == 2);
  CHECK(median_ratio(a, a) == 1);
  CHECK(std::isnan(median_ratio(TimeSpread(), TimeSpread())));
}

TEST_CASE("a row is compared with the printed one of its model, resolution and picture only") {
  const PrintedRow& printed = printed_rows[4];
  PaperRow row = row_like(printed, 0.5, 0.1);
  CHECK(comparable(row, 512) == &printed);
  CHECK(comparable(row, 256) == nullptr);
  row.substitute = true;
  CHECK(comparable(row, 512) == nullptr);
  row.substitute = false, row.resolution = 200;
  CHECK(comparable(row, 512) == nullptr);
  row.resolution = printed.resolution, row.scene.reset(); // missing
  CHECK(comparable(row, 512) == nullptr);
}

TEST_CASE("trends say where our figures go the way of the paper's") {
  PaperTorus torus;
  torus.voxel_pixels = 10;
  for (const PrintedMethod& p : printed_table_1) {
    torus.intersectors.emplace_back();
    torus.intersectors.back().method = p.method, torus.intersectors.back().ratio = p.ms;
  }
  for (const PrintedMethod& p : printed_table_2) {
    torus.normals.emplace_back();
    torus.normals.back().method = p.method, torus.normals.back().ratio = p.ms;
    torus.normals.back().jumps.p99 = p.method == "analytic" ? 9 : 2;
  }
  torus.intersectors[0].error.mean = 0.2, torus.intersectors[1].grid_error.p99 = 0.05; // 2 and 0.5 pixels
  std::vector<PaperRow> rows;
  for (const PrintedRow& printed : printed_rows) rows.push_back(row_like(printed, 0.81, 0.02));

  std::vector<PaperTrend> trends = paper_trends(torus, rows, 512);
  for (const char* claim : {"intersectors", "artifacts", "told apart"})
    CHECK(about(trends, 1, claim).agrees == "yes");
  for (const char* claim : {"schemes", "jump"}) CHECK(about(trends, 2, claim).agrees == "yes");
  CHECK(about(trends, 3, "save steps").agrees == "yes");
  CHECK(about(trends, 3, "save steps").ours == "27 of 27; 81 to 81 %");
  CHECK(about(trends, 3, "save steps").printed == "27 of 27; 22 to 80 %");
  CHECK(about(trends, 3, "the paper's part").agrees == "yes");
  CHECK(about(trends, 3, "save time").agrees == "yes");
  CHECK(about(trends, 4, "saves tests").agrees == "yes");
  CHECK(about(trends, 4, "costs steps").agrees == "in 0 of 18"); // ours fall, the paper's rise
  // The paper's time falls in 10: bunny and the finer dragons.
  CHECK(about(trends, 4, "saves time").agrees == "in 10 of 18");

  rows[2] = row_like(printed_rows[2], 0.75, 0.02); // the printed ones are 80, 79 and 72 %
  trends = paper_trends(torus, rows, 512);
  CHECK(about(trends, 3, "the paper's part").agrees == "in 25 of 27");

  std::swap(torus.normals[0].ratio, torus.normals[2].ratio); // 7.1 and 8.4
  torus.intersectors[1].grid_error.p99 = 0.15;
  for (PaperRow& row : rows)
    for (std::size_t i = 1; i < 4; ++i) row.scene->primary[i].saved = row.scene->shadow[i].saved = NAN;
  trends = paper_trends(torus, rows, 512);
  CHECK(about(trends, 2, "schemes").agrees == "no");
  CHECK(about(trends, 1, "told apart").agrees == "no");
  CHECK(std::none_of(trends.begin(), trends.end(), [](const PaperTrend& t) { // no times
    return t.table > 2 && t.claim.find("time") != std::string::npos;
  }));

  torus.normals[0].ratio = 1.019 * torus.normals[2].ratio;
  CHECK(about(paper_trends(torus, rows, 512), 2, "schemes").agrees == "yes"); // too near to tell

  for (PaperRow& row : rows) row.substitute = true;
  trends = paper_trends(torus, rows, 512);
  CHECK(std::all_of(trends.begin(), trends.end(), [](const PaperTrend& t) { return t.table < 3; }));
}

TEST_CASE("the torus tells the work and the errors of the methods of Tables 1 and 2") {
  const PaperTorus torus = measure_paper_torus(24, tiny(), silent);
  REQUIRE(torus.intersectors.size() == 4);
  CHECK(named(torus.intersectors, "false-position-1").interpolations == 2);
  CHECK(named(torus.intersectors, "false-position-4").interpolations == 5);
  const PaperMethod &exact = named(torus.intersectors, "exact"),
                    &midpoint = named(torus.intersectors, "midpoint"),
                    &one = named(torus.intersectors, "false-position-1"),
                    &four = named(torus.intersectors, "false-position-4");
  CHECK(exact.shape.lost() == 0);
  CHECK(exact.grid.lost() == 0);
  CHECK(exact.grid_error.max == 0);
  CHECK(midpoint.shape.phantoms > 0);
  CHECK(midpoint.grid_error.mean > one.grid_error.mean);
  CHECK(one.grid_error.mean > four.grid_error.mean);
  CHECK(torus.normals.size() == 3);
  CHECK(named(torus.normals, "analytic").samples == 8);
  CHECK(named(torus.normals, "analytic").jumps.p99 >
        2 * named(torus.normals, "interpolation-of-differences").jumps.p99);
  for (const auto* methods : {&torus.intersectors, &torus.normals}) {
    CHECK(methods->front().ratio == 1);
    for (const PaperMethod& m : *methods) CHECK(m.ms > 0);
  }
  // Its silhouette's area, by voxels in pixels: of a ring, seen from the front, radii 0.5 and 0.2, it is
  // 0.66, and 0.28 from the side, but for the perspective.
  const double pixel = 1.0 / 24 / torus.voxel_pixels;
  const double area = static_cast<double>(exact.grid.hits) * pixel * pixel;
  CHECK(area > 0.28);
  CHECK(area < 0.66 * 1.15);

  PaperSettings untimed = tiny();
  untimed.repetitions = 0;
  const PaperTorus again = measure_paper_torus(24, untimed, silent);
  CHECK(std::isnan(again.intersectors[1].ms));
  CHECK(std::isnan(again.intersectors[1].ratio));
  CHECK(again.intersectors[1].error.mean == one.error.mean);
}

TEST_CASE("ways of Tables 3 and 4 give the same answers with less work") {
  const BlockGrid grid = ball().grid(1.0 / 48, 3);
  double last = 0;
  const PaperScene scene = measure_paper_scene(grid, ball().bounds.min.y, tiny(), [&](double done) {
    CHECK(done >= last);
    last = done;
  });
  CHECK(last == Approx(1));
  CHECK(scene.primary_rays == 48 * 48);
  CHECK(scene.hits > 500);
  CHECK(scene.hits < scene.primary_rays);
  CHECK(scene.shadow_rays > scene.hits);
  REQUIRE(scene.primary.size() == 8);
  REQUIRE(scene.shadow.size() == 8);
  for (const auto* ways : {&scene.primary, &scene.shadow})
    for (const PaperWay& way : *ways) {
      INFO(way.name);
      CHECK(way.different == 0);
      CHECK(way.ms > 0);
      CHECK(way.counts.steps > 0);
    }
  // The paper's come first, in its order.
  for (std::size_t i = 0; i < 3; ++i) CHECK(scene.primary[i + 1].size == printed_minmax[i]);
  for (std::size_t i = 0; i < 2; ++i) CHECK(scene.shadow[i + 1].size == printed_occluder_steps[i]);
  CHECK(!scene.primary[3].leaps);
  CHECK(scene.primary[0].saved == 0);
  for (std::size_t i = 1; i < 4; ++i) CHECK(scene.primary[i].counts.steps < scene.primary[0].counts.steps);
  CHECK(scene.primary[4].counts.steps < scene.primary[0].counts.steps);
  CHECK(scene.shadow[2].counts.tests <
        scene.shadow[0].counts.tests); // 48 voxels of inside lie behind the front
  CHECK(scene.shadow[2].counts.steps > scene.shadow[0].counts.steps);
}

TEST_CASE("meshes are centred and scaled to a longest side of 1") {
  TriangleMesh mesh;
  mesh.vertices = {{10, 0, 0}, {14, 0, 0}, {10, 2, 0}, {10, 0, 1}, {99, 99, 99}}; // the last is not used
  mesh.triangles = {{0, 1, 2}, {0, 1, 3}};
  const Box3d box = centred_unit_mesh(mesh).bounds();
  CHECK(box.min == Vec3d(-0.5, -0.25, -0.125));
  CHECK(box.max == Vec3d(0.5, 0.25, 0.125));
}
