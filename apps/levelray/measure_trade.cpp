#include "measure_trade.hpp"

#include "measure_document.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace levelray {

namespace {

bool has_resolutions(const std::vector<TradeRow>& rows) {
  return std::any_of(rows.begin(), rows.end(), [](const TradeRow& r) { return r.resolution != 0; });
}

Json trade_table(const std::vector<TradeRow>& rows, bool normals, const std::string& unit) {
  const bool resolutions = has_resolutions(rows);
  std::vector<Column> columns{{"method", normals ? "scheme" : "intersector"},
                              {"front", "front"},
                              {"mean", "mean"},
                              {"p50", "p50"},
                              {"p99", "p99"},
                              {"max", "max"},
                              {"lost", "lost", 3, true},
                              {"ns", normals ? "ns/hit" : "ns/ray"},
                              {"megabytes", "MB"}};
  if (resolutions) columns.insert(columns.begin(), {"resolution", "resolution"});
  Table table(normals ? "trade-normals" : "trade-hits", (normals ? "Normals: " : "Hits: ") + unit, columns);
  for (const TradeRow& r : rows) {
    if (r.is_normals != normals) continue;
    Json::array_t row{r.method,     r.in_front ? "yes" : "",
                      r.error.mean, r.error.p50,
                      r.error.p99,  r.error.max,
                      r.lost,       r.ns,
                      r.megabytes};
    if (resolutions) row.insert(row.begin(), r.resolution);
    table.add(row);
  }
  return table.json();
}

Json trade_plot(const std::vector<TradeRow>& rows, bool normals, bool memory, const std::string& unit) {
  TradePlot plot(std::string(normals ? "normals" : "hits") + (memory ? "-memory" : "-time"),
                 std::string(normals ? "Normals" : "Hits") + (memory ? " against memory" : " against time"),
                 memory    ? "MB"
                 : normals ? "ns per hit"
                           : "ns per ray",
                 "mean of " + unit);
  for (const TradeRow& r : rows)
    if (r.is_normals == normals)
      plot.add(r.method, memory ? r.megabytes : r.ns, r.error.mean,
               r.resolution ? fmt::format("{}", r.resolution) : r.method);
  return plot.json();
}

} // namespace

Json trade_section(const std::vector<TradeRow>& rows, const TradeWords& words) {
  Json plots = Json::array();
  const bool memory = has_resolutions(rows); // of one grid it is all the same
  for (const bool normals : {false, true})
    for (const bool of_memory : {false, true})
      if (!of_memory || memory)
        plots.push_back(trade_plot(rows, normals, of_memory, normals ? words.normals : words.hits));
  return {{"id", "trade"},
          {"title", "The trade"},
          {"text",
           std::string("One mark for each configuration") + (memory ? ", labelled with its resolution" : "") +
               ". Large marks and the line are the Pareto front of the two quantities shown; the tables "
               "tell that of all."},
          {"plots", plots},
          {"tables", {trade_table(rows, false, words.hits), trade_table(rows, true, words.normals)}}};
}

Json thickness_json(const Thickness& thick) {
  return {{"points", thick.points}, {"p0.1", thick.p01},        {"p1", thick.p1},
          {"p5", thick.p5},         {"p50", thick.p50},         {"gaps", thick.gaps},
          {"gap_p1", thick.gap_p1}, {"gap_p50", thick.gap_p50}, {"thin_share", thick.thin_share}};
}

} // namespace levelray
