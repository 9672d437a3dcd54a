// Tables 3 and 4 of Jamriska 2010 in form, our numbers beside the printed ones; scripts/tables runs it.
//
// Every scheme's answers are compared with the plain ones before anything is timed. Schemes take turns; times
// are processor time of one thread, medians; savings are medians of the ratios within a repetition.
#include "bench/contest.hpp"
#include "bench/tables/printed.hpp"
#include "levelray/convert/mesh_to_grid.hpp"
#include "levelray/core/parallel.hpp"
#include "levelray/io/mesh_reader.hpp"
#include "levelray/mesh/prepare.hpp"
#include "levelray/trace/hit_normals.hpp"
#include "levelray/trace/level_set.hpp"
#include "support/study_scene.hpp"

#include <CLI/CLI.hpp>
#include <cstring>
#include <fmt/format.h>
#include <fstream>

using namespace levelray;
using namespace levelray::bench;

namespace {

constexpr int image_size = 512, tile = 32;
constexpr std::string_view intersector = "false-position-1",
                           scheme = "interpolation-of-differences"; // the paper's

struct Scene {
  LevelSet level_set;
  Occluders occluders;
  Camera camera;
  std::vector<WorldRay> rays;             // by tiles
  std::vector<std::array<int, 2>> pixels; // of the rays
  std::vector<WorldRay> shadow_rays;      // by tiles and lights

  explicit Scene(const BlockGrid& grid)
      : level_set(grid), occluders(grid, level_set.surface()), camera(settings()) {
    for (int ty = 0; ty < image_size; ty += tile)
      for (int tx = 0; tx < image_size; tx += tile)
        for (int y = ty; y < ty + tile; ++y)
          for (int x = tx; x < tx + tile; ++x) {
            pixels.push_back({x, y});
            rays.push_back(camera.ray(x + 0.5, y + 0.5));
          }
  }
  static CameraSettings settings() { // that of the study (support/study_scene.hpp)
    CameraSettings s;
    s.width = s.height = image_size;
    s.target = Vec3d(0, 0, 0);
    s.eye = Vec3d(0.35, 0.30, 1).normalized() * 1.58;
    return s;
  }
  PinholeView view() const {
    PinholeView v{camera.settings().eye, camera.right(), camera.up(), camera.forward()};
    v.half_height = v.half_width = camera.half_height();
    return v;
  }
};

// Traces the image as the renderer does, tile by tile, buffer included.
void trace_image(const Scene& scene, Traversal traversal, int minmax, std::vector<Hit>& hits,
                 std::vector<Vec3f>& normals) {
  std::optional<MinMaxBuffer> buffer;
  if (minmax > 0)
    buffer.emplace(scene.level_set.surface(), scene.level_set.grid().transform, scene.view(), minmax);
  constexpr std::size_t n = tile * tile;
  std::vector<RayBounds> bounds(minmax > 0 ? n : 0);
  for (std::size_t first = 0; first < scene.rays.size(); first += n) {
    for (std::size_t i = 0; i < bounds.size(); ++i)
      bounds[i] = buffer->at((scene.pixels[first + i][0] + 0.5) / image_size,
                             (scene.pixels[first + i][1] + 0.5) / image_size);
    PrimaryOptions options;
    options.intersector = intersector;
    options.traversal = traversal;
    options.bounds = bounds;
    const std::span rays(&scene.rays[first], n);
    const std::span own(&hits[first], n);
    closest_hits(scene.level_set, rays, options, own);
    hit_normals(scene.level_set, rays, own, scheme, {&normals[first], n});
  }
}

// Five lights around the zenith, and a ground under the object, as in the paper's Figure 7.
void make_shadow_rays(Scene& scene, const std::vector<Hit>& hits, const std::vector<Vec3f>& normals,
                      double ground) {
  std::vector<Vec3d> lights;
  for (int i = 0; i < 5; ++i)
    lights.push_back(Vec3d(std::cos(1.2566 * i + 0.5), 1.2, std::sin(1.2566 * i + 0.5)).normalized());
  constexpr std::size_t n = tile * tile;
  for (std::size_t first = 0; first < hits.size(); first += n)
    for (const Vec3d& light : lights)
      for (std::size_t i = first; i < first + n; ++i) {
        const WorldRay& ray = scene.rays[i];
        WorldRay shadow;
        shadow.direction = light;
        if (hits[i]) {
          if (!(Vec3d(normals[i]).dot(light) > 0)) continue;
          shadow.origin = ray.at(hits[i].t_outside);
        } else {
          const double t = (ground - ray.origin.y) / ray.direction.y;
          if (!(t > 0)) continue;
          shadow.origin = ray.at(t);
          if (!(Vec3d(shadow.origin.x, 0, shadow.origin.z).length() < 1.5)) continue;
        }
        scene.shadow_rays.push_back(shadow);
      }
}

CountSums trace_shadows(const Scene& scene, Traversal traversal, ShadowScheme how, int n_steps,
                        std::vector<char>& hidden) {
  ShadowOptions options;
  options.intersector = intersector;
  options.traversal = traversal, options.scheme = how, options.occluder_steps = n_steps;
  options.occluders = &scene.occluders;
  CountSums sums;
  constexpr std::size_t n = tile * tile;
  std::array<RayCounts, n> counts;
  std::array<bool, n> found;
  for (std::size_t first = 0; first < scene.shadow_rays.size(); first += n) {
    const std::size_t count = std::min(n, scene.shadow_rays.size() - first);
    any_hits(scene.level_set, {&scene.shadow_rays[first], count}, options, {found.data(), count},
             {counts.data(), count});
    for (std::size_t i = 0; i < count; ++i) hidden[first + i] = found[i], sums += counts[i];
  }
  return sums;
}

struct Row {
  std::string name;
  CountSums counts;
  double ms = 0, saved = 0; // processor time; part of the first row's that is saved
};

nlohmann::json to_json(const Row& row) {
  return {{"name", row.name},
          {"steps", row.counts.steps},
          {"tests", row.counts.tests},
          {"ms", row.ms},
          {"saved", row.saved}};
}

// Times, and savings against contestant `base` of each.
std::vector<Row> measure(std::vector<Contestant>& contestants, const std::vector<CountSums>& counts,
                         const std::vector<std::size_t>& base, int repetitions) {
  compete(contestants, repetitions);
  std::vector<Row> rows;
  for (std::size_t i = 0; i < contestants.size(); ++i) {
    const Spread ratio = cpu_ratio({&contestants[i]}, {&contestants[base[i]]});
    rows.push_back({contestants[i].name, counts[i], cpu(contestants[i]).median, 1 - ratio.median});
  }
  return rows;
}

template <class Work>
Contestant contestant(const std::string& name, Work work) {
  return {name, [work] {
            const Stopwatch watch;
            work();
            return watch.elapsed();
          }};
}

bool same(const Hit& a, const Hit& b) {
  return a.status == b.status && a.t == b.t && a.t_outside == b.t_outside && a.cell == b.cell;
}

std::vector<Row> table_3(const Scene& scene, int repetitions) {
  std::vector<Hit> hits(scene.rays.size()), first;
  std::vector<Vec3f> normals(scene.rays.size()), first_normals;
  std::vector<Contestant> contestants;
  std::vector<CountSums> counts;
  for (const Traversal traversal : {Traversal::plain, Traversal::leaps})
    for (const int minmax : {0, 256, 128, 64}) {
      const auto run = [&scene, &hits, &normals, traversal, minmax] {
        trace_image(scene, traversal, minmax, hits, normals);
      };
      run();
      if (first.empty()) first = hits, first_normals = normals;
      CountSums sums;
      for (std::size_t i = 0; i < hits.size(); ++i) {
        if (!same(hits[i], first[i]) || !(normals[i] == first_normals[i]))
          throw std::runtime_error("a hit differs from the plain traversal's");
        sums += hits[i].counts;
      }
      counts.push_back(sums);
      contestants.push_back(contestant((traversal == Traversal::plain ? "plain" : "leaps") +
                                           (minmax ? fmt::format(", {}^2", minmax) : ""),
                                       run));
    }
  return measure(contestants, counts, {0, 0, 0, 0, 4, 4, 4, 4}, repetitions);
}

std::vector<Row> table_4(const Scene& scene, int repetitions) {
  struct Way {
    const char* name;
    Traversal traversal;
    ShadowScheme scheme;
    int steps;
  };
  static constexpr Way ways[] = {{"plain", Traversal::plain, ShadowScheme::plain, 0},
                                 {"plain, n=12", Traversal::plain, ShadowScheme::occluder, 12},
                                 {"plain, n=32", Traversal::plain, ShadowScheme::occluder, 32},
                                 {"plain, boxes", Traversal::plain, ShadowScheme::boxes, 0},
                                 {"leaps", Traversal::leaps, ShadowScheme::plain, 0},
                                 {"leaps, n=12", Traversal::leaps, ShadowScheme::occluder, 12},
                                 {"leaps, boxes", Traversal::leaps, ShadowScheme::boxes, 0}};
  std::vector<char> hidden(scene.shadow_rays.size()), first;
  std::vector<Contestant> contestants;
  std::vector<CountSums> counts;
  for (const Way& way : ways) {
    const auto run = [&scene, &hidden, way] {
      return trace_shadows(scene, way.traversal, way.scheme, way.steps, hidden);
    };
    counts.push_back(run());
    if (first.empty()) first = hidden;
    if (hidden != first) throw std::runtime_error("a shadow differs from the plain traversal's");
    contestants.push_back(contestant(way.name, run));
  }
  return measure(contestants, counts, {0, 0, 0, 0, 4, 4, 4}, repetitions);
}

std::string thousands(std::uint64_t n) {
  return fmt::format("{}", (n + 500) / 1000);
}
double reduction(double now, double before) {
  return 100 * (1 - now / before);
}

} // namespace

int main(int argc, char** argv) try {
  std::vector<std::string> models;
  std::vector<int> resolutions{128, 256, 512};
  int repetitions = 7;
  std::string json_path;
  CLI::App app{"Tables 3 and 4 of Jamriska 2010, measured; one thread, 512x512 pixels.\n"
               "Example: bench_tables bunny=bunny.obj dragon=dragon.obj buddha=buddha.obj"};
  app.add_option("models", models, "NAME=FILE, the names as in the paper: bunny, dragon, buddha")->required();
  app.add_option("--resolution", resolutions, "Voxels along the longest side, one or more (128 256 512)")
      ->check(CLI::Range(16, 2048));
  app.add_option("--repeat", repetitions, "Repetitions; medians are printed (7)")->check(CLI::Range(1, 1000));
  app.add_option("--json", json_path, "Also write everything measured to this file");
  CLI11_PARSE(app, argc, argv);

  const ThreadLimit one_thread(1);
  const nlohmann::json machine = describe_machine();
  fmt::print("{}; {}; one thread, processor time, medians of {}\n\n", machine["processor"].get<std::string>(),
             machine["compiler"].get<std::string>(), repetitions);
  nlohmann::json all{{"machine", machine}, {"rows", nlohmann::json::array()}};
  std::string primary =
      "| | plain: steps k | ms | 256^2: steps k | saved | 128^2: steps k | saved | 64^2: steps k | saved | "
      "paper, "
      "steps: 256^2, 128^2, 64^2 | paper, time | leaps: steps k | ms | 128^2: steps k | saved |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n";
  std::string shadows = "| | plain: steps k | tests k | ms | n=12: steps k | tests k | saved | n=32: steps k "
                        "| tests k | saved | paper, "
                        "tests: 12, 32 | paper, time | leaps: ms | n=12: saved | boxes: tests k | saved |\n"
                        "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n";
  std::vector<std::string> failures;
  for (const std::string& model : models) {
    const std::size_t equals = model.find('=');
    if (equals == std::string::npos) throw std::runtime_error(model + " is not NAME=FILE");
    const std::string name = model.substr(0, equals);
    const TriangleMesh mesh = test::centred_unit_mesh(read_mesh(model.substr(equals + 1)).mesh);
    for (const int resolution : resolutions) {
      ConvertOptions convert;
      convert.resolution = resolution;
      const BlockGrid grid = mesh_to_grid(prepare_mesh(mesh), convert).grid;
      Scene scene(grid);
      const std::vector<Row> three = table_3(scene, repetitions);
      std::vector<Hit> hits(scene.rays.size());
      std::vector<Vec3f> normals(scene.rays.size());
      trace_image(scene, Traversal::leaps, 0, hits, normals);
      make_shadow_rays(scene, hits, normals, mesh.bounds().min.y);
      const std::vector<Row> four = table_4(scene, repetitions);

      const PrintedRow* paper = nullptr;
      for (const PrintedRow& row : printed_rows)
        if (name == row.model && resolution == row.resolution) paper = &row;
      const std::string title = fmt::format("{} {}", name, resolution);
      const auto percent = [](double part) { return fmt::format("{:.0f} %", 100 * part); };
      const auto fewer = [&](const Row& row, const Row& base) {
        return fmt::format("{} (-{:.0f} %)", thousands(row.counts.steps),
                           reduction(double(row.counts.steps), double(base.counts.steps)));
      };
      primary += fmt::format("| {} | {} | {:.1f} |", title, thousands(three[0].counts.steps), three[0].ms);
      for (std::size_t i = 1; i < 4; ++i)
        primary += fmt::format(" {} | {} |", fewer(three[i], three[0]), percent(three[i].saved));
      std::string paper_steps, paper_times, paper_tests, paper_shadow_times;
      for (std::size_t i = 1; paper && i < 4; ++i) {
        const double printed = reduction(paper->primary_steps[i], paper->primary_steps[0]);
        const double ours = reduction(double(three[i].counts.steps), double(three[0].counts.steps));
        paper_steps += fmt::format("{}-{:.0f}", i > 1 ? ", " : "", printed);
        paper_times +=
            fmt::format("{}{:.0f}", i > 1 ? ", " : "", reduction(paper->primary_ms[i], paper->primary_ms[0]));
        if (ours < printed)
          failures.push_back(fmt::format("{}, {}: steps fall by {:.1f} %, the paper's by {:.1f} %", title,
                                         three[i].name, ours, printed));
        if (three[i].saved < (name == "buddha" ? -0.02 : 0))
          failures.push_back(
              fmt::format("{}, {}: takes {:.1f} % longer", title, three[i].name, -100 * three[i].saved));
      }
      for (std::size_t i = 1; paper && i < 3; ++i) {
        paper_tests += fmt::format("{}-{:.0f}", i > 1 ? ", " : "",
                                   reduction(paper->shadow_tests[i], paper->shadow_tests[0]));
        paper_shadow_times +=
            fmt::format("{}{:.0f}", i > 1 ? ", " : "", reduction(paper->shadow_ms[i], paper->shadow_ms[0]));
      }
      primary += fmt::format(" {} % | {} % | {} | {:.1f} | {} | {} |\n", paper_steps, paper_times,
                             thousands(three[4].counts.steps), three[4].ms, thousands(three[6].counts.steps),
                             percent(three[6].saved));
      shadows += fmt::format("| {} | {} | {} | {:.1f} |", title, thousands(four[0].counts.steps),
                             thousands(four[0].counts.tests), four[0].ms);
      for (std::size_t i = 1; i < 3; ++i)
        shadows += fmt::format(" {} | {} | {} |", thousands(four[i].counts.steps),
                               thousands(four[i].counts.tests), percent(four[i].saved));
      shadows +=
          fmt::format(" {} % | {} % | {:.1f} | {} | {} | {} |\n", paper_tests, paper_shadow_times, four[4].ms,
                      percent(four[5].saved), thousands(four[6].counts.tests), percent(four[6].saved));
      for (const std::size_t i : {3, 6})
        if (four[i].saved < -0.02)
          failures.push_back(
              fmt::format("{}, {}: takes {:.1f} % longer", title, four[i].name, -100 * four[i].saved));
      nlohmann::json row{
          {"model", name}, {"resolution", resolution}, {"shadow_rays", scene.shadow_rays.size()}};
      for (const Row& r : three) row["primary"].push_back(to_json(r));
      for (const Row& r : four) row["shadow"].push_back(to_json(r));
      all["rows"].push_back(row);
      fmt::print(stderr, "{} done\n", title);
    }
  }
  fmt::print("Primary rays (Table 3)\n\n{}\nShadow rays towards five lights (Table 4)\n\n{}\n", primary,
             shadows);
  for (const std::string& failure : failures) fmt::print("NOT MET: {}\n", failure);
  if (failures.empty())
    fmt::print("Met: steps fall at least as in the paper; time is saved on every bunny and dragon row; "
               "nothing costs more than 2 %\n");
  if (!json_path.empty()) {
    std::ofstream out(json_path);
    out << all.dump(1) << "\n";
    if (!out.flush()) throw std::runtime_error("cannot write " + json_path);
  }
  return failures.empty() ? 0 : 3;
} catch (const std::exception& error) {
  fmt::print(stderr, "bench_tables: {}\n", error.what());
  return 1;
}
