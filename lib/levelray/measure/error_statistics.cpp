#include "levelray/measure/error_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace levelray {

double error_quantile(const std::vector<double>& ascending, double q) {
  const double rank = std::ceil(q * static_cast<double>(ascending.size()));
  return ascending[static_cast<std::size_t>(std::max(rank, 1.0)) - 1];
}

ErrorStatistics error_statistics(std::vector<double> values) {
  ErrorStatistics result;
  result.count = values.size();
  if (values.empty()) return result;
  std::sort(values.begin(), values.end());
  const auto quantile = [&](double q) { return error_quantile(values, q); };
  double sum = 0;
  for (const double value : values) sum += value;
  result.mean = sum / static_cast<double>(values.size());
  result.p50 = quantile(0.5), result.p99 = quantile(0.99), result.p999 = quantile(0.999);
  result.max = values.back();
  return result;
}

double log_log_slope(const std::vector<double>& sizes, const std::vector<double>& errors) {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    if (!(errors[i] > 0 && sizes[i] > 0)) return std::numeric_limits<double>::quiet_NaN();
    const double u = std::log(sizes[i]), v = std::log(errors[i]);
    n += 1, x += u, y += v, xx += u * u, xy += u * v;
  }
  const double spread = n * xx - x * x;
  return n >= 2 && spread > 0 ? (n * xy - x * y) / spread : std::numeric_limits<double>::quiet_NaN();
}

} // namespace levelray
