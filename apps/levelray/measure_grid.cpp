// `levelray measure IN.vdb`: the user's own level set as a document.
#include "input.hpp"
#include "levelray/convert/field_facts.hpp"
#include "levelray/core/error.hpp"
#include "levelray/measure/grid_suite.hpp"
#include "measure_document.hpp"
#include "measure_suites.hpp"
#include "measure_trade.hpp"

#include <fmt/format.h>

namespace levelray {

namespace {

Json proof_table(const GridSuiteResult& r) {
  Table table("proofs", "Exact hits; bounds in voxels",
              {{"rays", "rays"},
               {"hits", "hits"},
               {"crossings", "proven crossings"},
               {"grazes", "grazes"},
               {"refuted", "refuted", 3, true},
               {"odd", "wrong parity", 3, true},
               {"p50", "bound p50"},
               {"p99", "p99"},
               {"max", "max"}});
  table.add({r.rays, r.hits, r.crossings, r.grazes, r.refuted, r.odd, r.bounds_voxels.p50,
             r.bounds_voxels.p99, r.bounds_voxels.max});
  return table.json();
}

Json field_table(const FieldFacts& f) {
  Table table("field", "The samples within a voxel of the surface",
              {{"crossings", "crossings"},
               {"steep", "steep"},
               {"gradients", "gradients"},
               {"p5", "length p5"},
               {"p50", "p50"},
               {"p95", "p95"},
               {"distance", "a distance"}});
  table.add({f.crossings, fmt::format("{:.2f} %", 100 * f.steep_share), f.gradients, f.gradient_low,
             f.gradient_median, f.gradient_high, f.is_distance() ? "yes" : "no"});
  return table.json();
}

} // namespace

void measure_grid(const MeasureOptions& options, Progress& progress, Json& document) {
  if (!options.resolutions.empty())
    throw Error(ErrorKind::usage, "--resolution is for meshes: a .vdb has the voxels that it has");
  const LoadedGrid loaded = load_grid(options.input, ConversionOptions{}, options.common, progress);
  const GridSuiteSettings settings{options.rays, options.seed, options.repeat};
  progress.begin("measuring", 0, "");
  const GridSuiteResult result =
      run_grid_suite(loaded.grid, settings, [&](double done) { progress.report(done); });
  const FieldFacts facts = field_facts(loaded.grid);
  const double voxel = loaded.grid.transform.voxel_size;

  document["title"] = "levelray measure: " + printable(options.input.path, 200);
  document["options"] = {{"input", options.input.json()},
                         {"rays", settings.rays},
                         {"seed", settings.seed},
                         {"repeat", settings.repetitions}};
  document["grid"] = grid_json(loaded.grid);
  document["field"] = field_json(facts);
  document["thickness"] = thickness_json(result.thickness);
  add_field_facts(document, loaded);

  Json& failures = document["failures"];
  if (result.refuted)
    failures.push_back(fmt::format("{} exact hits are refuted: the ray is proven clear of the surface there",
                                   with_commas(result.refuted)));
  if (result.odd)
    failures.push_back(fmt::format("{} rays have crossings that do not fit the sides of their ends",
                                   with_commas(result.odd)));
  Json& findings = document["findings"];
  if (result.hits == 0) findings.push_back("no ray meets a surface");
  if (!facts.is_distance()) findings.push_back("no distance: " + describe_field(facts));
  const Thickness& thick = result.thickness;
  if (thick.points && thick.thin_share.front() > 0.01)
    findings.push_back(
        fmt::format("{:.1f} % of the surface is thinner than 2 voxels; 1 % thinner than {:.4g} "
                    "({:.2g} voxels): voxels of {:.4g} would give that 2",
                    100 * thick.thin_share.front(), thick.p1, thick.p1 / voxel, thick.p1 / 2));
  document["notes"] = {
      fmt::format("Grid \"{}\": {} active samples, voxel {:.5g}, band {:.3g} voxels.",
                  printable(loaded.grid.name, 100), with_commas(loaded.grid.active_sample_count()), voxel,
                  loaded.grid.half_width_voxels()),
      "What a level set was made from, it does not tell: its own surface, where the interpolant of its "
      "samples "
      "is 0, is the truth here. Measure the mesh to see what conversion loses.",
      "A crossing is proven where the interpolant is positive on one side and not on the other by sums of "
      "doubles without rounding, and clear of 0 before; its bound holds for the distance along the ray to "
      "the "
      "true first root. A graze comes within rounding of the surface without such a proof.",
      "The error of a hit is the interpolant's size there, for a distance that from its surface. Normals are "
      "compared with the interpolant's own gradient, which jumps at faces of cells: smoother schemes differ "
      "from it because they are smoother. Lost: leaks, phantoms and wrong surfaces against exact hits.",
      "Thickness is measured from hits against their normals to the next crossing, gaps along them."};
  document["sections"].push_back(trade_section(
      result.trade, {"sizes of the interpolant at hits", "degrees to the interpolant's gradient"}));
  document["sections"].push_back({{"id", "proofs"},
                                  {"title", "Proofs"},
                                  {"text", "What is proven about the hits of the exact intersector."},
                                  {"plots", Json::array()},
                                  {"tables", {proof_table(result)}}});
  document["sections"].push_back({{"id", "field"},
                                  {"title", "Field"},
                                  {"text", "A distance has gradients of length 1."},
                                  {"plots", Json::array()},
                                  {"tables", {field_table(facts)}}});
}

} // namespace levelray
