#include "levelray/measure/paper_trends.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <fmt/format.h>
#include <functional>
#include <iterator>

namespace levelray {

namespace {

const PaperMethod& method_of(const std::vector<PaperMethod>& methods, std::string_view name) {
  const auto at =
      std::find_if(methods.begin(), methods.end(), [&](const PaperMethod& m) { return m.method == name; });
  assert(at != methods.end());
  return *at;
}

// Several cells of a table, the paper's figures and ours, and a claim of all of them. Cells with NaN are
// none.
struct Cells {
  std::vector<double> printed, ours;

  void add(double paper, double own) {
    if (!(own == own)) return;
    printed.push_back(paper), ours.push_back(own);
  }
  // "27 of 27; 22 to 80 %", of savings.
  template <class Holds>
  static std::string count(const std::vector<double>& values, Holds&& holds) {
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    return fmt::format("{} of {}; {:.0f} to {:.0f} %", std::count_if(values.begin(), values.end(), holds),
                       values.size(), 100 * *least, 100 * *most);
  }
  // "in k of n": where it holds for both or for neither.
  template <class Holds>
  PaperTrend trend(int table, const std::string& claim, Holds&& holds) const {
    std::size_t agree = 0;
    for (std::size_t i = 0; i < ours.size(); ++i) agree += holds(printed[i]) == holds(ours[i]);
    return {table, claim, count(printed, holds), count(ours, holds),
            agree == ours.size() ? "yes" : fmt::format("in {} of {}", agree, ours.size())};
  }
};

// "midpoint 1, false-position-1 1.05, ...", by rising values.
std::string order_of(std::vector<std::pair<double, std::string>> values) {
  std::sort(values.begin(), values.end());
  std::string text;
  for (const auto& [value, name] : values)
    text += fmt::format("{}{} {:.3g}", text.empty() ? "" : ", ", name, value);
  return text;
}

// Whether times rise in the same order, those within 2 % of each other, which repetitions do not tell apart,
// in any.
template <class Printed>
void add_order(std::vector<PaperTrend>& trends, int table, const std::string& claim, const Printed& printed,
               const std::vector<PaperMethod>& methods) {
  std::vector<std::pair<double, std::string>> theirs, ours;
  for (const PrintedMethod& p : printed) {
    theirs.emplace_back(p.ms / std::begin(printed)->ms, p.method);
    ours.emplace_back(method_of(methods, p.method).ratio, p.method);
    if (!(ours.back().first > 0)) return; // no times
  }
  bool agrees = true;
  for (std::size_t i = 0; i < ours.size(); ++i)
    for (std::size_t k = 0; k < ours.size(); ++k)
      if (theirs[i].first < theirs[k].first && ours[i].first > 1.02 * ours[k].first) agrees = false;
  trends.push_back({table, claim, order_of(theirs), order_of(ours), agrees ? "yes" : "no"});
}

void add_torus(std::vector<PaperTrend>& trends, const PaperTorus& torus) {
  add_order(trends, 1, "intersectors from quick to slow, to 2 %", printed_table_1, torus.intersectors);
  const PaperMethod &one = method_of(torus.intersectors, "false-position-1"),
                    &four = method_of(torus.intersectors, "false-position-4"),
                    &midpoint = method_of(torus.intersectors, "midpoint");
  const auto pixels = [&](double voxels) { return voxels * torus.voxel_pixels; };
  trends.push_back({1, "midpoint has severe artifacts", "a picture",
                    fmt::format("off by {:.1f} pixels, mean; {} hits where there is nothing",
                                pixels(midpoint.error.mean), midpoint.shape.phantoms),
                    pixels(midpoint.error.mean) > 1 ? "yes" : "no"});
  const double apart = pixels(one.grid_error.p99);
  trends.push_back(
      {1, "one and four iterations cannot be told apart", "a picture",
       fmt::format("99 % of one's hits within {:.2g} pixels of the grid's surface, four's {:.2g}", apart,
                   pixels(four.grid_error.p99)),
       apart < 1 ? "yes" : "no"});
  add_order(trends, 2, "normal schemes from quick to slow, to 2 %", printed_table_2, torus.normals);
  const double analytic = method_of(torus.normals, "analytic").jumps.p99;
  const double others = std::max(method_of(torus.normals, "difference-of-interpolations").jumps.p99,
                                 method_of(torus.normals, "interpolation-of-differences").jumps.p99);
  trends.push_back(
      {2, "analytic normals jump between cells", "a picture",
       fmt::format("1 % of neighbouring pixels' differ by over {:.2g} degrees too much, others' by {:.2g}",
                   analytic, others),
       analytic > 2 * others ? "yes" : "no"});
}

} // namespace

const PrintedRow* comparable(const PaperRow& row, int image_size) {
  return row.scene && !row.substitute && image_size == printed_image_size
             ? printed_row(row.model, row.resolution)
             : nullptr;
}

std::vector<PaperTrend> paper_trends(const PaperTorus& torus, const std::vector<PaperRow>& rows,
                                     int image_size) {
  std::vector<PaperTrend> trends;
  add_torus(trends, torus);

  Cells steps3, time3, steps4, tests4, time4; // savings, as parts
  std::vector<double> more3;                  // ours beyond the paper's
  const auto saved = [](double now, double before) { return 1 - now / before; };
  const auto part = [&](std::uint64_t now, std::uint64_t before) {
    return saved(static_cast<double>(now), static_cast<double>(before));
  };
  for (const PaperRow& row : rows) {
    const PrintedRow* printed = comparable(row, image_size);
    if (!printed) continue;
    const std::vector<PaperWay>&primary = row.scene->primary, &shadow = row.scene->shadow;
    for (std::size_t i = 1; i <= std::size(printed_minmax); ++i) {
      const double theirs = saved(printed->primary_steps[i], printed->primary_steps[0]);
      const double ours = part(primary[i].counts.steps, primary[0].counts.steps);
      steps3.add(theirs, ours), more3.push_back(ours - theirs);
      time3.add(saved(printed->primary_ms[i], printed->primary_ms[0]), primary[i].saved);
    }
    for (std::size_t i = 1; i <= std::size(printed_occluder_steps); ++i) {
      steps4.add(saved(printed->shadow_steps[i], printed->shadow_steps[0]),
                 part(shadow[i].counts.steps, shadow[0].counts.steps));
      tests4.add(saved(printed->shadow_tests[i], printed->shadow_tests[0]),
                 part(shadow[i].counts.tests, shadow[0].counts.tests));
      time4.add(saved(printed->shadow_ms[i], printed->shadow_ms[0]), shadow[i].saved);
    }
  }
  if (steps3.ours.empty()) return trends;
  const auto positive = [](double x) { return x > 0; };
  trends.push_back(steps3.trend(3, "min/max buffers save steps", positive));
  const auto as_much = std::count_if(more3.begin(), more3.end(), [](double x) { return x >= 0; });
  const bool all = as_much == static_cast<std::ptrdiff_t>(more3.size());
  trends.push_back({3, "... at least the paper's part of them", "",
                    fmt::format("{} of {}", as_much, more3.size()),
                    all ? "yes" : fmt::format("in {} of {}", as_much, more3.size())});
  if (!time3.ours.empty()) trends.push_back(time3.trend(3, "they save time", positive));
  trends.push_back(tests4.trend(4, "looking ahead for the inside saves tests", positive));
  trends.push_back(steps4.trend(4, "it costs steps", [](double x) { return x < 0; }));
  if (!time4.ours.empty()) trends.push_back(time4.trend(4, "it saves time", positive));
  return trends;
}

} // namespace levelray
