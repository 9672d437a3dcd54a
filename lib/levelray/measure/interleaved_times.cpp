#include "levelray/measure/interleaved_times.hpp"

#include "levelray/core/parallel.hpp"

#include <algorithm>
#include <ctime>

namespace levelray {

namespace {

double now() {
  timespec time{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) * 1e9 + static_cast<double>(time.tv_nsec);
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
    std::sort(times[i].begin(), times[i].end());
    const std::size_t m = times[i].size();
    spreads[i] = {(times[i][(m - 1) / 2] + times[i][m / 2]) / 2, times[i].front(), times[i].back()};
  }
  return spreads;
}

} // namespace levelray
