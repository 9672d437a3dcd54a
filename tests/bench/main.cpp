// Measures levelray against its peers in one run; scripts/bench builds and starts it.
#include "bench/convert_contest.hpp"
#include "bench/trace_contest.hpp"
#include "levelray/core/parallel.hpp"
#include "levelray/io/mesh_reader.hpp"
#include "levelray/measure/study_scene.hpp"
#include "support/knobbly_mesh.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fstream>

using namespace levelray;

int main(int argc, char** argv) try {
  std::string mesh_path, json_path;
  std::vector<int> resolutions{256, 512}, threads{1, 2};
  bool only_convert = false, only_trace = false, smoke = false;
  int repetitions = 7;
  bench::TraceSetup trace;
  CLI::App app{
      "Measure levelray's conversion and tracing against OpenVDB's (and Embree's rays on the mesh).\n"
      "Results are verified before times are printed; contestants take turns in rotated order.\n"
      "Example: bench_levelray bunny.obj --resolution 256 512 --threads 1 2 --json out.json"};
  app.add_option("mesh", mesh_path, "Mesh file (default: a knobbly ball of 82 thousand triangles)");
  app.add_option("--resolution", resolutions, "Voxels along the longest side, one or more (256 512)")
      ->check(CLI::Range(16, 4096));
  app.add_option("--threads", threads, "Numbers of threads, one or more (1 2)")->check(CLI::Range(1, 1024));
  app.add_option("--size", trace.image_size, "Pixels along each side of the image (512)")
      ->check(CLI::Range(32, 8192));
  app.add_option("--repeat", repetitions, "Repetitions; medians are printed (7)")->check(CLI::Range(1, 1000));
  app.add_option("--intersector", trace.intersector, "levelray's intersector (exact)");
  app.add_option("--normals", trace.normals, "levelray's normals (interpolation-of-differences)");
  app.add_flag("--only-convert", only_convert, "Leave out the rays");
  app.add_flag("--only-trace", only_trace, "Leave out the conversion")->excludes("--only-convert");
  app.add_flag("!--no-embree", trace.embree, "Leave out Embree");
  app.add_flag("--smoke", smoke,
               "A tiny run that shows that everything works: 48 voxels, 64 pixels, 2 repetitions");
  app.add_option("--json", json_path, "Also write everything measured to this file");
  CLI11_PARSE(app, argc, argv);
  if (smoke) resolutions = {48}, threads = {1}, trace.image_size = 64, repetitions = 2;

  const nlohmann::json machine = bench::describe_machine();
  fmt::print("{}\n{}; {}; OpenVDB {}; Embree {}; load {:.1f}\n\n", machine["processor"].get<std::string>(),
             machine["compiler"].get<std::string>(), machine["flags"].get<std::string>(),
             machine["openvdb"].get<std::string>(),
             bench::has_embree() ? "3" : "not found when this was built",
             machine["load_average"].get<double>());
  const TriangleMesh mesh =
      centred_unit_mesh(mesh_path.empty() ? test::knobbly_mesh() : read_mesh(mesh_path).mesh);
  fmt::print("{}: {} triangles\n\n", mesh_path.empty() ? "knobbly ball" : mesh_path, mesh.triangles.size());

  nlohmann::json results{{"machine", machine},
                         {"mesh", mesh_path.empty() ? "knobbly ball" : mesh_path},
                         {"convert", nlohmann::json::array()},
                         {"trace", nlohmann::json::array()}};
  for (const int n : resolutions)
    for (const int count : threads) {
      const ThreadLimit limit(count);
      if (!only_trace) results["convert"].push_back(bench::convert_contest(mesh, {n, 3, count, repetitions}));
      if (only_convert) continue;
      trace.resolution = n, trace.threads = count, trace.repetitions = repetitions;
      results["trace"].push_back(bench::trace_contest(mesh, trace));
    }
  if (!json_path.empty()) {
    std::ofstream out(json_path);
    out << results.dump(1) << "\n";
    if (!out.flush()) throw std::runtime_error("cannot write " + json_path);
  }
  return 0;
} catch (const std::exception& error) {
  fmt::print(stderr, "bench_levelray: {}\n", error.what());
  return 1;
}
