// The suites of `levelray measure`: each has a file of its own and a line in the list.
#pragma once

#include "console.hpp"
#include "options.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace levelray {

// As given; what a suite does not know of, it leaves alone.
struct MeasureOptions {
  CommonOptions common;
  InputOptions input; // its path is empty for suites
  std::string suite, report, resolutions, shapes, models, band = "3vx";
  std::size_t rays = 8192;
  std::uint64_t seed = 1;
  int repeat = 3, size = 512;
};

struct MeasureSuite {
  const char* name;
  const char* help;
  // Measures, and fills in everything of the document (measure_document.hpp) but command, version and
  // machine.
  void (*run)(const MeasureOptions& options, Progress& progress, Json& document);
};

void measure_analytic(const MeasureOptions& options, Progress& progress, Json& document);
void measure_openvdb(const MeasureOptions& options, Progress& progress, Json& document);
void measure_paper(const MeasureOptions& options, Progress& progress, Json& document);
void measure_extremes(const MeasureOptions& options, Progress& progress, Json& document);

inline const std::vector<MeasureSuite>& measure_suites() {
  static const std::vector<MeasureSuite> suites{
      {"analytic", "shapes whose distance, hits and normals are known without a grid", measure_analytic},
      {"openvdb", "the same grids and rays through OpenVDB's tracer and ours", measure_openvdb},
      {"paper", "Tables 1 to 4 of Jamriska 2010, ours beside the printed figures", measure_paper},
      {"extremes",
       "rays, cells, grids, shapes, meshes, files and machines at the edge, each right, refused or wrong",
       measure_extremes}};
  return suites;
}

// A mesh or a level set of the user's, options.input.
void measure_mesh(const MeasureOptions& options, Progress& progress, Json& document);
void measure_grid(const MeasureOptions& options, Progress& progress, Json& document);

// Of --band. Throws Error(usage).
double band_voxels(const MeasureOptions& options);
// "32,64,128": whole numbers. Throws Error(usage), naming the option.
std::vector<int> parse_counts(const std::string& option, const std::string& text, int least, int most);

} // namespace levelray
