#include "measure_paper_tables.hpp"

#include "measure_analytic.hpp"
#include "measure_document.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <iterator>

namespace levelray {

namespace {

Json thousands(std::uint64_t n) {
  return static_cast<std::int64_t>((n + 500) / 1000);
}
// Figures of the paper, which has whole numbers of steps and tests.
Json printed_json(double value) {
  return value == std::round(value) ? Json(static_cast<std::int64_t>(value)) : Json(value);
}
Json percent(double part) {
  return finite_json(100 * part);
}
std::string sides_text(int x, int y, int z) {
  return fmt::format("{}x{}x{}", x, y, z);
}
// Tables 1 and 2 lie on their side: methods are columns.
template <class Printed>
Json method_table(const std::string& id, const std::string& title, const Printed& printed,
                  const std::vector<PaperMethod>& methods, const std::vector<std::string>& figures,
                  bool same_picture) {
  std::vector<Column> columns{{"figure", "figure"}};
  const auto printed_of = [&](const std::string& name) -> const PrintedMethod* {
    for (const PrintedMethod& p : printed)
      if (p.method == name) return &p;
    return nullptr;
  };
  for (const PaperMethod& m : methods) {
    const PrintedMethod* p = printed_of(m.method);
    const std::string group = p ? std::string(p->title) : m.method + " (not in the paper)";
    columns.push_back({m.method, "ours", 3, false, group});
    if (p) columns.push_back({m.method + "_printed", "paper", 4, false, group, true});
  }
  Table table(id, title, columns);
  for (const std::string& figure : figures) {
    Json::array_t row{figure};
    const auto add = [&](const PaperMethod& m, const Json& ours, const Json& paper) {
      row.push_back(ours);
      if (printed_of(m.method)) row.push_back(paper);
    };
    for (const PaperMethod& m : methods) {
      const PrintedMethod* p = printed_of(m.method);
      const Json ms = p && same_picture ? Json(p->ms) : Json(nullptr);
      const Json ratio = p && same_picture ? Json(p->ms / std::begin(printed)->ms) : Json(nullptr);
      if (figure == "#samples")
        add(m, m.samples, p ? Json(p->samples) : Json(nullptr));
      else if (figure == "#interpolations")
        add(m, m.interpolations, p ? Json(p->interpolations) : Json(nullptr));
      else if (figure == "time [ms]")
        add(m, finite_json(m.ms), ms);
      else
        add(m, finite_json(m.ratio), ratio);
    }
    table.add(row);
  }
  return table.json();
}

// The printed row that belongs to this one; of missing models too.
const PrintedRow* printed_beside(const PaperRow& row, int image_size) {
  if (row.scene) return comparable(row, image_size);
  return image_size == printed_image_size ? printed_row(row.model, row.resolution) : nullptr;
}

// Table 3 (shadows: 4): a group of columns for each of the paper's ways.
Json scene_table(const std::vector<PaperRow>& rows, int image_size, bool shadows) {
  const bool compare = std::any_of(rows.begin(), rows.end(), [&](const PaperRow& row) {
    return printed_beside(row, image_size) != nullptr;
  });
  std::vector<Column> columns{{"model", "model"}, {"resolution", "resolution"}, {"voxels", "voxels"}};
  const auto add_column = [&](const std::string& key, const std::string& title, const std::string& group) {
    columns.push_back({key, title, 3, false, group});
    if (compare) columns.push_back({key + "_printed", "paper", 4, false, group, true});
  };
  if (compare) columns.push_back({"voxels_printed", "paper", 3, false, "", true});
  std::vector<std::string> groups{shadows ? "no acceleration" : "without buffers"};
  if (shadows)
    for (const int n : printed_occluder_steps) groups.push_back(fmt::format("n={}", n));
  else
    for (const int size : printed_minmax) groups.push_back(fmt::format("{0}x{0} buffers", size));
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const std::string at =
        g ? fmt::format("_{}", shadows ? printed_occluder_steps[g - 1] : printed_minmax[g - 1])
          : std::string();
    add_column("steps" + at, "steps, k", groups[g]);
    if (shadows) add_column("tests" + at, "tests, k", groups[g]);
    add_column("ms" + at, "ms", groups[g]);
    if (g) add_column("saved" + at, "saved, %", groups[g]);
  }
  Table table(shadows ? "table-4" : "table-3",
              shadows ? "Table 4: shadow rays with normal and modified traversal"
                      : "Table 3: primary rays without and with min/max buffers",
              columns);
  for (const PaperRow& row : rows) {
    const PrintedRow* p = printed_beside(row, image_size);
    Json::array_t line{row.model, row.resolution,
                       row.scene ? sides_text(row.voxels.x, row.voxels.y, row.voxels.z) : "missing"};
    if (compare)
      line.push_back(p ? Json(sides_text(p->voxels[0], p->voxels[1], p->voxels[2])) : Json(nullptr));
    const auto add = [&](const Json& ours, double printed) {
      line.push_back(row.scene ? ours : Json(nullptr));
      if (compare) line.push_back(p ? printed_json(printed) : Json(nullptr));
    };
    static const PaperWay none;
    for (std::size_t g = 0; g < groups.size(); ++g) {
      const PaperWay& way = !row.scene ? none : shadows ? row.scene->shadow[g] : row.scene->primary[g];
      static constexpr PrintedRow blank{};
      const PrintedRow& q = p ? *p : blank;
      add(thousands(way.counts.steps), shadows ? q.shadow_steps[g] : q.primary_steps[g]);
      if (shadows) add(thousands(way.counts.tests), q.shadow_tests[g]);
      add(finite_json(way.ms), shadows ? q.shadow_ms[g] : q.primary_ms[g]);
      if (g) add(percent(way.saved), shadows ? q.shadow_saved[g - 1] : q.primary_saved[g - 1]);
    }
    table.add(line);
  }
  return table.json();
}

} // namespace

Json paper_table_1(const PaperTorus& torus, int image_size) {
  return method_table("table-1", "Table 1: intersection in a surface cell", printed_table_1,
                      torus.intersectors, {"#interpolations", "time [ms]", "time by the first's"},
                      image_size == printed_image_size);
}
Json paper_table_2(const PaperTorus& torus, int image_size) {
  return method_table("table-2", "Table 2: surface normals", printed_table_2, torus.normals,
                      {"#samples", "#interpolations", "time [ms]", "time by the first's"},
                      image_size == printed_image_size);
}
Json paper_table_3(const std::vector<PaperRow>& rows, int image_size) {
  return scene_table(rows, image_size, false);
}
Json paper_table_4(const std::vector<PaperRow>& rows, int image_size) {
  return scene_table(rows, image_size, true);
}

Json paper_hit_table(const std::vector<PaperTorus>& tori) {
  Table table("hits",
              "The same in numbers: hits against the torus and against the grid's own surface; errors "
              "of t in voxels",
              hit_columns("intersector", true,
                          {{"voxel_pixels", "voxel, pixels"},
                           {"t_mean", "t mean"},
                           {"t_p99", "t p99"},
                           {"t_max", "t max"},
                           {"grid_leaks", "leaks", 3, true, "grid's own surface"},
                           {"grid_phantoms", "phantoms", 3, true, "grid's own surface"},
                           {"grid_wrong", "wrong", 3, true, "grid's own surface"},
                           {"grid_mean", "t mean", 3, false, "grid's own surface"},
                           {"grid_p99", "t p99", 3, false, "grid's own surface"},
                           {"ms", "ms/picture"}}));
  for (const PaperTorus& torus : tori)
    for (const PaperMethod& m : torus.intersectors)
      table.add(
          hit_row(torus.at, m.method, m.shape, true,
                  {torus.voxel_pixels, m.error.mean, m.error.p99, m.error.max, m.grid.leaks, m.grid.phantoms,
                   m.grid.wrong, m.grid_error.mean, m.grid_error.p99, finite_json(m.ms)}));
  return table.json();
}

Json paper_normal_table(const std::vector<PaperTorus>& tori) {
  Table table("normals", "The same in numbers: angles to the torus' normals, degrees",
              {{"resolution", "resolution"},
               {"method", "scheme"},
               {"hits", "hits"},
               {"mean", "mean"},
               {"p50", "p50"},
               {"p99", "p99"},
               {"max", "max"},
               {"jump_p99", "jump p99"},
               {"jump_max", "jump max"},
               {"ms", "ms/picture"}});
  for (const PaperTorus& torus : tori)
    for (const PaperMethod& m : torus.normals)
      table.add({torus.at.resolution, m.method, m.error.count, m.error.mean, m.error.p50, m.error.p99,
                 m.error.max, m.jumps.p99, m.jumps.max, finite_json(m.ms)});
  return table.json();
}

Json paper_trade_plot(const std::vector<PaperTorus>& tori, bool normals) {
  TradePlot plot(normals ? "normals-time" : "hits-time", normals ? "Normals" : "Hits", "ms per picture",
                 normals ? "mean angle, degrees" : "mean |t error|");
  for (const PaperTorus& torus : tori)
    for (const PaperMethod& m : normals ? torus.normals : torus.intersectors)
      plot.add(m.method, m.ms, m.error.mean * (normals ? 1 : torus.at.voxel_size),
               fmt::format("{}", torus.at.resolution));
  return plot.json();
}

// All ways, those that the paper does not have too.
Json paper_way_table(const std::vector<PaperRow>& rows, bool shadows) {
  Table table(shadows ? "shadow-ways" : "primary-ways",
              shadows ? "All ways of shadow rays" : "All ways of primary rays",
              {{"model", "model"},
               {"resolution", "resolution"},
               {"way", "way"},
               {"rays", "rays"},
               {"different", "different", 3, true},
               {"steps", "steps"},
               {"tests", "tests"},
               {"ms", "ms"},
               {"base", "against"},
               {"saved", "saved, %"}});
  for (const PaperRow& row : rows) {
    if (!row.scene) continue;
    const std::vector<PaperWay>& ways = shadows ? row.scene->shadow : row.scene->primary;
    for (const PaperWay& way : ways)
      table.add({row.model, row.resolution, way.name,
                 shadows ? row.scene->shadow_rays : row.scene->primary_rays, way.different, way.counts.steps,
                 way.counts.tests, finite_json(way.ms), ways[way.base].name, percent(way.saved)});
  }
  return table.json();
}

Json paper_subject_table(const std::vector<PaperSubject>& subjects) {
  Table table("models", "Models",
              {{"model", "model"},
               {"file", "file"},
               {"triangles", "triangles"},
               {"closed", "closed"},
               {"turned", "turned"},
               {"source", "source"}});
  for (const PaperSubject& s : subjects)
    table.add({s.name, s.file.empty() ? (s.substitute ? "none" : "missing") : s.file,
               s.triangles ? Json(s.triangles) : Json(nullptr),
               s.file.empty() && !s.substitute ? ""
               : s.closed                      ? "yes"
                                               : "no",
               s.turned ? "z up to y up" : "", s.source});
  return table.json();
}

Json paper_trend_table(const std::vector<PaperTrend>& trends) {
  Table table("trends", "The paper's claims",
              {{"table", "table"},
               {"claim", "claim"},
               {"agrees", "agrees"},
               {"ours", "ours"},
               {"printed", "paper", 3, false, "", true}});
  for (const PaperTrend& t : trends) table.add({t.table, t.claim, t.agrees, t.ours, t.printed});
  return table.json();
}

} // namespace levelray
