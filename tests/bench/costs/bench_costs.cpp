// Measures the table of lib/levelray/measure/method_costs.cpp and prints its rows.
//
//   bench_costs [REPEATS]
//
// Take a quiet machine. The figures are ratios of processor times that were measured in turns, so that a busy
// one still gives about the same.
#include "levelray/convert/mesh_to_grid.hpp"
#include "levelray/core/parallel.hpp"
#include "levelray/intersect/intersectors.hpp"
#include "levelray/measure/interleaved_times.hpp"
#include "levelray/measure/made_meshes.hpp"
#include "levelray/measure/ray_sets.hpp"
#include "levelray/measure/sampled_shape.hpp"
#include "levelray/normal/normals.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>

using namespace levelray;

namespace {

using LogSums = std::map<std::string, double>; // of the ratios to exact's time per ray

void measure(const Reference& shape, int repeats, LogSums& intersectors, LogSums& normals) {
  constexpr int resolution = 128;
  const double voxel = shape.bounds.size().length() / resolution;
  const BlockGrid grid = shape.grid(voxel, 3);
  const LevelSet level_set(grid);
  const std::vector<WorldRay> rays = random_chords(shape.bounds, 1 << 16, 1);
  std::vector<Hit> exact(rays.size()), hits(rays.size());
  std::vector<Vec3f> found(rays.size());
  closest_hits(level_set, rays, Exact::name, exact);
  const auto hit_count = static_cast<double>(
      std::count_if(exact.begin(), exact.end(), [](const Hit& hit) { return static_cast<bool>(hit); }));

  std::vector<std::function<void()>> works;
  const std::vector<std::string> solvers = method_names<Intersectors>(),
                                 schemes = method_names<NormalSchemes>();
  for (const std::string& name : solvers)
    works.push_back([&, name] {
      in_batches(rays.size(), [&](std::size_t begin, std::size_t count) {
        closest_hits(level_set, {&rays[begin], count}, name, {&hits[begin], count});
      });
    });
  for (const std::string& name : schemes)
    works.push_back([&, name] {
      in_batches(rays.size(), [&](std::size_t begin, std::size_t count) {
        hit_normals(level_set, {&rays[begin], count}, {&exact[begin], count}, name, {&found[begin], count});
      });
    });
  const std::vector<TimeSpread> times = interleaved_times(works, repeats);
  const auto of_exact =
      static_cast<std::size_t>(std::find(solvers.begin(), solvers.end(), Exact::name) - solvers.begin());
  const double per_ray = times[of_exact].median / static_cast<double>(rays.size());
  for (std::size_t i = 0; i < solvers.size(); ++i)
    intersectors[solvers[i]] += std::log(times[i].median / static_cast<double>(rays.size()) / per_ray);
  for (std::size_t i = 0; i < schemes.size(); ++i)
    normals[schemes[i]] += std::log(times[solvers.size() + i].median / hit_count / per_ray);
}

// The times of rays by `exact` and of conversions, and what they are explained by.
struct Model {
  // Normal equations of time = base + step * steps + test * tests, each row weighted by 1 / time: a line of
  // least relative errors.
  double square[3][3] = {}, right[3] = {};
  double exact_sum = 0, conversion_sum = 0; // of the logarithms of ns per ray and per active sample
  int exact_count = 0, conversion_count = 0;

  void add(double ns, double steps, double tests) {
    const double row[3] = {1 / ns, steps / ns, tests / ns};
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) square[i][j] += row[i] * row[j];
      right[i] += row[i];
    }
  }
  // By Cramer's rule.
  std::array<double, 3> solve() const {
    const auto det = [](const double(&m)[3][3]) {
      return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
             m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
             m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
    };
    std::array<double, 3> x;
    for (int c = 0; c < 3; ++c) {
      double m[3][3];
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) m[i][j] = j == c ? right[i] : square[i][j];
      x[static_cast<std::size_t>(c)] = det(m) / det(square);
    }
    return x;
  }
};

// Rays through a shape's grid, and conversions of a mesh.
void measure_model(const Reference& shape, int repeats, Model& model) {
  for (const int resolution : {32, 64, 128, 256}) {
    const BlockGrid grid = shape.grid(shape.bounds.size().length() / resolution, 3);
    const LevelSet level_set(grid);
    const std::vector<WorldRay> rays = random_chords(shape.bounds, 1 << 15, 1);
    std::vector<Hit> hits(rays.size());
    const double ns =
        interleaved_times(
            {[&] {
              in_batches(rays.size(), [&](std::size_t begin, std::size_t count) {
                closest_hits(level_set, {&rays[begin], count}, PrimaryOptions(), {&hits[begin], count});
              });
            }},
            repeats)[0]
            .median;
    const auto count = static_cast<double>(rays.size());
    CountSums sums;
    for (const Hit& hit : hits) sums += hit.counts;
    model.add(ns / count, static_cast<double>(sums.steps) / count, static_cast<double>(sums.tests) / count);
    if (resolution == 128) model.exact_sum += std::log(ns / count), ++model.exact_count;
  }
}

void measure_conversion(const TriangleMesh& mesh, int repeats, Model& model) {
  const PreparedMesh prepared = prepare_mesh(mesh);
  for (const int resolution : {32, 64, 128, 256}) {
    ConvertOptions options;
    options.voxel_size = prepared.report.bounds.size().length() / resolution;
    const auto samples = static_cast<double>(mesh_to_grid(prepared, options).grid.active_sample_count());
    const double ns =
        interleaved_times({[&] { LevelSet(mesh_to_grid(prepared, options).grid); }}, repeats)[0].median;
    model.conversion_sum += std::log(ns / samples), ++model.conversion_count;
  }
}

void print(const char* title, const LogSums& sums, std::size_t shapes) {
  std::vector<std::pair<double, std::string>> rows;
  for (const auto& [name, sum] : sums) rows.emplace_back(std::exp(sum / static_cast<double>(shapes)), name);
  std::sort(rows.begin(), rows.end());
  std::printf("%s\n", title);
  for (const auto& [cost, name] : rows) std::printf("    {\"%s\", %.2f},\n", name.c_str(), cost);
}

} // namespace

int main(int argc, char** argv) {
  const int repeats = argc > 1 ? std::max(1, std::atoi(argv[1])) : 7;
  const ThreadLimit one_thread(1);
  LogSums intersectors, normals;
  const std::vector<Reference> shapes = all_references();
  for (const Reference& shape : shapes) measure(shape, repeats, intersectors, normals);
  print("intersectors, per ray", intersectors, shapes.size());
  print("normals, per hit", normals, shapes.size());

  Model model;
  for (const Reference& shape : shapes) measure_model(shape, repeats, model);
  measure_conversion(box_mesh(Vec3d(0, 0, 0), Vec3d(1, 0.7, 0.4)), repeats, model);
  measure_conversion(torus_mesh(64, 32), repeats, model);
  measure_conversion(ball_mesh(256, 128, 1), repeats, model);
  const std::array<double, 3> line = model.solve();
  const double exact = std::exp(model.exact_sum / model.exact_count);
  std::printf("a ray by exact: %.1f ns; as this many of them:\n    ray %.3f, step %.4f, test %.4f\n"
              "    active sample converted %.4f\n",
              exact, line[0] / exact, line[1] / exact, line[2] / exact,
              std::exp(model.conversion_sum / model.conversion_count) / exact);
}
