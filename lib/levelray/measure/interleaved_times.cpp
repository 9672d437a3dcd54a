#include "levelray/measure/interleaved_times.hpp"

#include "levelray/core/parallel.hpp"

#include <algorithm>
#include <cassert>
#include <ctime>
#include <limits>
#include <utility>

namespace levelray {

namespace {

double now() {
  timespec time{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) * 1e9 + static_cast<double>(time.tv_nsec);
}

double median(const std::vector<double>& sorted) {
  const std::size_t n = sorted.size();
  return (sorted[(n - 1) / 2] + sorted[n / 2]) / 2;
}

} // namespace

std::vector<TimeSpread> interleaved_times(const std::vector<std::function<void()>>& works, int repetitions) {
  const std::size_t n = works.size();
  std::vector<std::vector<double>> times(n);
  for (const auto& work : works) {
    check_cancel();
    work();
  }
  for (int r = 0; r < repetitions; ++r)
    for (std::size_t i = 0; i < n; ++i) {
      check_cancel();
      const std::size_t which = (i + static_cast<std::size_t>(r)) % n;
      const double start = now();
      works[which]();
      times[which].push_back(now() - start);
    }
  std::vector<TimeSpread> spreads(n);
  for (std::size_t i = 0; i < n && repetitions > 0; ++i) {
    spreads[i].each = times[i];
    std::sort(times[i].begin(), times[i].end());
    spreads[i].median = median(times[i]);
    spreads[i].min = times[i].front(), spreads[i].max = times[i].back();
  }
  return spreads;
}

double median_ratio(const TimeSpread& of, const TimeSpread& by) {
  assert(of.each.size() == by.each.size());
  if (of.each.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::vector<double> ratios;
  for (std::size_t i = 0; i < of.each.size(); ++i) ratios.push_back(of.each[i] / by.each[i]);
  std::sort(ratios.begin(), ratios.end());
  return median(ratios);
}

} // namespace levelray
