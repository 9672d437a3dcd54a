// The suite `extremes` as a document: one table of verdicts, failures first.
#include "levelray/core/error.hpp"
#include "levelray/io/extreme_mesh_files.hpp"
#include "levelray/measure/extremes.hpp"
#include "levelray/vdb/extreme_vdb_files.hpp"
#include "measure_document.hpp"
#include "measure_suites.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <map>

namespace levelray {

void measure_extremes(const MeasureOptions& options, Progress& progress, Json& document) {
  ExtremeSettings settings;
  settings.seed = options.seed;
  std::vector<ExtremeRow> rows = extreme_rows();
  for (const auto& group : {extreme_mesh_file_rows, extreme_vdb_rows})
    for (ExtremeRow& row : group()) rows.push_back(std::move(row));
  std::vector<ExtremeResult> results;
  progress.begin("measuring", 0, "");
  for (const ExtremeRow& row : rows) {
    results.push_back(run_extreme(row, settings));
    progress.report(static_cast<double>(results.size()) / static_cast<double>(rows.size()));
  }
  // Red ones first; the others as they come.
  std::stable_partition(results.begin(), results.end(), [](const ExtremeResult& result) {
    return result.outcome.verdict == ExtremeVerdict::red;
  });

  Table table("extremes", "Verdicts",
              {{"verdict", "verdict", 3, true},
               {"group", "group"},
               {"row", "row"},
               {"expected", "expected", 3, false, "", false, true},
               {"detail", "first counter-example, or the refusal", 3, false, "", false, true},
               {"cases", "cases"},
               {"worst", "worst error"},
               {"unit", "in"},
               {"seconds", "seconds", 2}});
  std::map<ExtremeVerdict, std::size_t> counts;
  for (const ExtremeResult& result : results) {
    const ExtremeOutcome& outcome = result.outcome;
    ++counts[outcome.verdict];
    const Json worst = outcome.unit.empty() ? Json(nullptr) : finite_json(outcome.worst);
    const std::string detail = printable(outcome.detail, 2000);
    table.add({verdict_name(outcome.verdict), result.group, result.name, result.expected, detail,
               outcome.cases, worst, outcome.unit, result.seconds});
    if (outcome.verdict == ExtremeVerdict::red)
      document["failures"].push_back(fmt::format("{}: {}: {}", result.group, result.name, detail));
  }

  document["title"] = "levelray measure: extremes";
  document["options"] = {{"seed", settings.seed}};
  document["verdicts"] = {{"green", counts[ExtremeVerdict::green]},
                          {"refused", counts[ExtremeVerdict::refused]},
                          {"red", counts[ExtremeVerdict::red]}};
  document["notes"] = {
      fmt::format(
          "{} rows: {} green, {} refused, {} red. Green: the answer is right in every case. Refused: "
          "turned down with the line shown, as documented. Red: wrong, with the first counter-example, "
          "whose numbers are hexadecimal so that it can be rerun.",
          results.size(), counts[ExtremeVerdict::green], counts[ExtremeVerdict::refused],
          counts[ExtremeVerdict::red]),
      "Who is right is decided without the code in question: hits by a plain loop over all cells near the "
      "ray in "
      "long double, and by signs in exact numbers; distances and signs of meshes by sums over all triangles; "
      "symmetries and switches by doing things twice and comparing bits. Errors are those of clear hits; "
      "grazes may be wherever rounding of f, as documented, allows."};
  document["sections"].push_back({{"id", "verdicts"},
                                  {"title", "Verdicts"},
                                  {"text", document["notes"][0]},
                                  {"plots", Json::array()},
                                  {"tables", {table.json()}}});
  document["notes"].erase(0);
}

} // namespace levelray
