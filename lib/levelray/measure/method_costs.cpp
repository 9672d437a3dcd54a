#include "levelray/measure/method_costs.hpp"

#include "levelray/core/error.hpp"

#include <algorithm>
#include <span>

namespace levelray {

namespace {

struct MethodCost {
  std::string_view name;
  double cost;
};

// bench_costs on a 2-core AVX-512 Xeon (virtual), g++ 12 -O3.
constexpr MethodCost intersector_costs[] = {
    {"midpoint", 0.76},         {"false-position-1", 0.92},
    {"false-position-2", 0.95}, {"false-position-3", 0.96},
    {"false-position-4", 0.96}, {"newton", 0.97},
    {"marmitt", 0.98},          {"exact", 1.00},
    {"sphere-tracing", 1.16},
};
constexpr MethodCost normal_costs[] = {
    {"analytic", 0.57},
    {"offset-differences", 0.72},
    {"interpolation-of-differences", 0.79},
    {"difference-of-interpolations", 0.79},
    {"tricubic-b-spline", 1.13},
    {"dual-voxel", 1.41},
    {"sharp-features", 1.46},
};

double cost_of(std::span<const MethodCost> costs, std::string_view name) {
  const auto found =
      std::find_if(costs.begin(), costs.end(), [&](const MethodCost& row) { return row.name == name; });
  if (found == costs.end())
    throw Error(ErrorKind::usage, "no cost is known of " + printable(std::string(name), 80));
  return found->cost;
}

std::vector<std::string> by_cost(std::span<const MethodCost> costs) {
  std::vector<MethodCost> rows(costs.begin(), costs.end());
  std::stable_sort(rows.begin(), rows.end(),
                   [](const MethodCost& a, const MethodCost& b) { return a.cost < b.cost; });
  std::vector<std::string> names;
  for (const MethodCost& row : rows) names.emplace_back(row.name);
  return names;
}

} // namespace

double intersector_cost(std::string_view name) {
  return cost_of(intersector_costs, name);
}

double normals_cost(std::string_view name) {
  return cost_of(normal_costs, name);
}

// A line through the times of eleven shapes at four sizes, least relative errors.
double ray_cost(double steps, double tests) {
  return 0.298 + 0.144 * steps + 0.285 * tests;
}

double conversion_cost(double active_samples) {
  return 0.66 * active_samples;
}

std::vector<std::string> intersectors_by_cost() {
  return by_cost(intersector_costs);
}

std::vector<std::string> normals_by_cost() {
  return by_cost(normal_costs);
}

} // namespace levelray
