// Measures the table of lib/levelray/measure/method_costs.cpp and prints its rows.
//
//   bench_costs [REPEATS]
//
// Take a quiet machine. The figures are ratios of processor times that were measured in turns, so that a busy
// one still gives about the same.
#include "levelray/core/parallel.hpp"
#include "levelray/intersect/intersectors.hpp"
#include "levelray/measure/interleaved_times.hpp"
#include "levelray/measure/ray_sets.hpp"
#include "levelray/measure/sampled_shape.hpp"
#include "levelray/normal/normals.hpp"

#include <algorithm>
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
}
