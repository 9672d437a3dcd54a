// Fair times: those compared take turns, each repetition beginning with another one, so that what disturbs
// the machine disturbs all.
#pragma once

#include <functional>
#include <vector>

namespace levelray {

struct TimeSpread {
  double median = 0, min = 0, max = 0; // nanoseconds of the process' processor time, all threads together
  std::vector<double> each;            // of each repetition
};

// Runs each once without counting, then `repetitions` times in rotated order. Stops where parallel loops
// would (core/parallel.hpp).
std::vector<TimeSpread> interleaved_times(const std::vector<std::function<void()>>& works, int repetitions);

// The median over repetitions of the first's time by the second's: steadier than the ratio of medians,
// because what a repetition suffers both suffer. NaN without repetitions.
double median_ratio(const TimeSpread& of, const TimeSpread& by);

} // namespace levelray
