// Means and quantiles of errors.
#pragma once

#include <cstddef>
#include <vector>

namespace levelray {

struct ErrorStatistics {
  std::size_t count = 0;
  double mean = 0, p50 = 0, p99 = 0, p999 = 0, max = 0; // 0 where there is nothing
};

// A quantile q is the smallest value that at least q of all values do not exceed.
ErrorStatistics error_statistics(std::vector<double> values);
double error_quantile(const std::vector<double>& ascending, double q); // of at least one value

// The slope of log(error) over log(size) by least squares; NaN for fewer than two points, and where an error
// is not positive.
double log_log_slope(const std::vector<double>& sizes, const std::vector<double>& errors);

} // namespace levelray
