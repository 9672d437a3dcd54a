// The suite `analytic` as a document: tables of solvers, normals, accelerations, slopes, and a plot of each
// shape's errors.
#include "measure_analytic.hpp"
#include "levelray/core/error.hpp"
#include "levelray/intersect/intersectors.hpp"
#include "levelray/measure/analytic_suite.hpp"
#include "measure_document.hpp"
#include "names.hpp"

#include <cmath>
#include <fmt/format.h>
#include <map>

namespace levelray {

AnalyticSettings analytic_settings(const MeasureOptions& options) {
  AnalyticSettings settings;
  if (!options.resolutions.empty())
    settings.resolutions = parse_counts("--resolution", options.resolutions, 8, 4096);
  if (!options.shapes.empty()) settings.shapes = split_list(options.shapes);
  settings.half_width_voxels = band_voxels(options);
  settings.chords = options.rays;
  settings.image_size = std::max(4, static_cast<int>(std::sqrt(static_cast<double>(options.rays))));
  settings.seed = options.seed;
  settings.repetitions = options.repeat;
  return settings;
}

Json analytic_options_json(const AnalyticSettings& settings) {
  return {{"resolution", settings.resolutions},
          {"shapes", settings.shapes},
          {"band_voxels", settings.half_width_voxels},
          {"primary_rays", settings.image_size * settings.image_size},
          {"random_rays", settings.chords},
          {"seed", settings.seed},
          {"repeat", settings.repetitions}};
}

std::string faults_text(const Confusion& c) {
  std::string text;
  const auto add = [&](std::uint64_t n, const char* one, const char* many) {
    if (n) text += (text.empty() ? "" : ", ") + counted(n, one, many);
  };
  add(c.leaks, "leak", "leaks");
  add(c.phantoms, "phantom", "phantoms");
  add(c.wrong, "wrong surface", "wrong surfaces");
  return text;
}

std::vector<Column> hit_columns(const std::string& title, bool unresolved, const std::vector<Column>& more) {
  std::vector<Column> columns{{"shape", "shape"},
                              {"resolution", "resolution"},
                              {"method", title},
                              {"hits", "hits"},
                              {"misses", "misses"},
                              {"leaks", "leaks", 3, true},
                              {"phantoms", "phantoms", 3, true},
                              {"wrong", "wrong", 3, true}};
  if (unresolved) columns.push_back({"unresolved", "unresolved"});
  columns.insert(columns.end(), more.begin(), more.end());
  return columns;
}

Json::array_t hit_row(const Sampling& at, const std::string& method, const Confusion& c, bool unresolved,
                      const Json::array_t& more) {
  Json::array_t row{at.shape, at.resolution, method, c.hits, c.misses, c.leaks, c.phantoms, c.wrong};
  if (unresolved) row.push_back(c.unresolved);
  row.insert(row.end(), more.begin(), more.end());
  return row;
}

Json convergence_plots(const std::vector<Convergence>& curves, const std::string& quantity,
                       const std::string& what) {
  std::vector<std::string> shapes;
  for (const Convergence& c : curves)
    if (c.quantity == quantity && (shapes.empty() || shapes.back() != c.shape)) shapes.push_back(c.shape);
  Json plots = Json::array();
  for (const std::string& shape : shapes) {
    LogLogPlot plot(quantity + "-" + shape, shape, "voxel size", what);
    for (const Convergence& c : curves)
      if (c.shape == shape && c.quantity == quantity)
        plot.add(c.method, c.mean_slope, c.voxel_sizes, c.means);
    plots.push_back(plot.json());
  }
  return plots;
}

namespace {

std::string where(const Sampling& at) {
  return fmt::format("{} at {}", at.shape, at.resolution);
}

// What breaks a promise.
Json failures_of(const AnalyticResult& result) {
  Json failures = Json::array();
  for (const SolverRow& row : result.solvers)
    if (row.method == Exact::name && row.shape.lost())
      failures.push_back(fmt::format("{}: {} of {} rays: {}, more than sampling explains", row.method,
                                     where(row.at), with_commas(row.shape.rays()), faults_text(row.shape)));
  for (const AccelerationRow& row : result.accelerations)
    if (row.different)
      failures.push_back(fmt::format("{} ({}): {}: {} that differ from the first way's", row.method, row.rays,
                                     where(row.at), counted(row.different, "answer", "answers")));
  return failures;
}

// What other methods lose against the grid's own surface, all samplings together; and what sampling loses.
Json findings_of(const AnalyticResult& result) {
  std::vector<std::string> order;
  std::map<std::string, Confusion> sums;
  Json findings = Json::array();
  for (const SolverRow& row : result.solvers) {
    if (!sums.contains(row.method)) order.push_back(row.method);
    Confusion& sum = sums[row.method];
    sum.hits += row.grid.hits, sum.misses += row.grid.misses, sum.leaks += row.grid.leaks;
    sum.phantoms += row.grid.phantoms, sum.wrong += row.grid.wrong;
  }
  for (const std::string& method : order)
    if (const Confusion& sum = sums[method]; sum.lost())
      findings.push_back(fmt::format("{}: {} of {} rays against the grid's own surface", method,
                                     faults_text(sum), with_commas(sum.rays())));
  // A line per shape, with the resolutions that lose more than one hit in a hundred.
  std::string shape, shares;
  const auto end_line = [&] {
    if (!shares.empty())
      findings.push_back(
          fmt::format("{}: sampling does not resolve {} of the hits; smaller voxels would", shape, shares));
    shares.clear();
  };
  for (const SolverRow& row : result.solvers) {
    if (row.method != Exact::name) continue;
    if (row.at.shape != shape) end_line();
    shape = row.at.shape;
    const double hits = static_cast<double>(row.shape.hits + row.shape.unresolved);
    const double share = static_cast<double>(row.shape.unresolved) / std::max(1.0, hits);
    if (share > 0.01)
      shares += fmt::format("{}{:.1f} % (at {})", shares.empty() ? "" : ", ", 100 * share, row.at.resolution);
  }
  end_line();
  return findings;
}

Json solver_table(const AnalyticResult& result) {
  Table table("solvers", "Hits of intersectors; errors in voxels",
              hit_columns("intersector", true,
                          {{"t_mean", "t mean"},
                           {"t_p50", "t p50"},
                           {"t_p99", "t p99"},
                           {"t_p999", "t p99.9"},
                           {"t_max", "t max"},
                           {"primary_ns", "ns/primary"},
                           {"chord_ns", "ns/random"},
                           {"steps", "steps/hit"},
                           {"samples", "samples/hit"},
                           {"interpolations", "interp./hit"}}));
  for (const SolverRow& r : result.solvers)
    table.add(hit_row(r.at, r.method, r.shape, true,
                      {r.t.mean, r.t.p50, r.t.p99, r.t.p999, r.t.max, r.primary_ns, r.chord_ns, r.steps,
                       r.samples, r.interpolations}));

  return table.json();
}

Json grid_table(const AnalyticResult& result) {
  Table table("grid", "The same hits against the grid's own surface, as the exact intersector finds it",
              hit_columns("intersector", false,
                          {{"t_mean", "t mean"},
                           {"t_p50", "t p50"},
                           {"t_p99", "t p99"},
                           {"t_p999", "t p99.9"},
                           {"t_max", "t max"},
                           {"distance_mean", "distance mean"},
                           {"distance_max", "distance max"}}));
  for (const SolverRow& r : result.solvers)
    table.add(hit_row(r.at, r.method, r.grid, false,
                      {r.grid_t.mean, r.grid_t.p50, r.grid_t.p99, r.grid_t.p999, r.grid_t.max,
                       r.distance.mean, r.distance.max}));

  return table.json();
}

Json normal_table(const AnalyticResult& result) {
  Table table("normals", "Normals at exact hits; errors in degrees",
              {{"shape", "shape"},
               {"resolution", "resolution"},
               {"method", "scheme"},
               {"hits", "hits"},
               {"mean", "mean"},
               {"p50", "p50"},
               {"p99", "p99"},
               {"p999", "p99.9"},
               {"max", "max"},
               {"ns", "ns/hit"},
               {"samples", "samples"},
               {"interpolations", "interp."}});
  for (const NormalRow& r : result.normals)
    table.add({r.at.shape, r.at.resolution, r.method, r.degrees.count, r.degrees.mean, r.degrees.p50,
               r.degrees.p99, r.degrees.p999, r.degrees.max, r.ns, r.samples, r.interpolations});
  return table.json();
}

Json acceleration_table(const AnalyticResult& result) {
  Table table("accelerations", "Accelerations, with the exact intersector; per ray",
              {{"shape", "shape"},
               {"resolution", "resolution"},
               {"rays", "rays"},
               {"method", "way"},
               {"different", "different", 3, true},
               {"steps", "steps"},
               {"tests", "tests"},
               {"ns", "ns"}});
  for (const AccelerationRow& r : result.accelerations)
    table.add({r.at.shape, r.at.resolution, r.rays, r.method, r.different, r.steps, r.tests, r.ns});
  return table.json();
}

Json slope_table(const AnalyticResult& result) {
  Table table(
      "slopes",
      "Slopes of log(error) over log(voxel size): 2 means that half the voxel has a quarter of the error",
      {{"shape", "shape"},
       {"smooth", "smooth"},
       {"quantity", "error of"},
       {"method", "method"},
       {"mean", "of the mean"},
       {"median", "of the median"},
       {"finest", "two finest, mean"}});
  for (const Convergence& c : result.convergence)
    table.add({c.shape, c.smooth ? "yes" : "no", c.quantity, c.method, finite_json(c.mean_slope),
               finite_json(c.median_slope), finite_json(c.finest_slope)});
  return table.json();
}

} // namespace

void measure_analytic(const MeasureOptions& options, Progress& progress, Json& document) {
  const AnalyticSettings settings = analytic_settings(options);
  progress.begin("measuring", 0, "");
  const AnalyticResult result = run_analytic_suite(settings, [&](double done) { progress.report(done); });

  document["title"] = "levelray measure: shapes that are known exactly";
  document["options"] = analytic_options_json(settings);
  document["failures"] = failures_of(result);
  document["findings"] = findings_of(result);
  document["notes"] = {
      "A resolution of N means voxels of 1/N; all shapes are about 1 in size. Each is seen by the pixels of "
      "a square "
      "picture and crossed by random chords of the sphere around it, the same at all resolutions.",
      "Errors of t are against the shape itself, and so include what sampling and trilinear interpolation do "
      "to it. "
      "Leaks (a hit not found), phantoms (one where there is none) and wrong surfaces are counted where "
      "sampling "
      "does not explain them: a ray is called unresolved, instead, where the shape stays within the "
      "interpolation "
      "error of the surface, h²/8 times the sum of its second derivatives' bounds, or 0.87 voxels where the "
      "field "
      "has kinks. The table against the grid's own surface excuses nothing.",
      "Times are of one thread's processor time, medians of runs in turns; work of rays that miss is counted "
      "with "
      "the hits. Normals are compared with the shape's at its point nearest to the hit."};

  document["sections"].push_back(
      {{"id", "hits"},
       {"title", "Hits"},
       {"text", "Mean error of t along the ray, in units of the shape, against the voxel size. Trilinear "
                "interpolation allows a slope of 2 where the surface is smooth and resolved."},
       {"plots", convergence_plots(result.convergence, "t", "mean |t error|")},
       {"tables", {solver_table(result), grid_table(result)}}});
  document["sections"].push_back(
      {{"id", "normals"},
       {"title", "Normals"},
       {"text", "Mean angle between the scheme's normal and the shape's, against the voxel "
                "size."},
       {"plots", convergence_plots(result.convergence, "normal", "mean angle, degrees")},
       {"tables", {normal_table(result)}}});
  document["sections"].push_back(
      {{"id", "slopes"},
       {"title", "Convergence"},
       {"text", "Fitted over all resolutions, coarse ones that do not resolve thin parts "
                "included. The distance is that of the hit from the shape's surface."},
       {"plots", Json::array()},
       {"tables", {slope_table(result)}}});
  document["sections"].push_back(
      {{"id", "accelerations"},
       {"title", "Accelerations"},
       {"text", "Ways to find the same answers. Different: answers that are not bit for bit "
                "those of the first way, over all intersectors."},
       {"plots", Json::array()},
       {"tables", {acceleration_table(result)}}});
}

} // namespace levelray
