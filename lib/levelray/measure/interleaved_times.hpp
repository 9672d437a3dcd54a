// Fair times: those compared take turns, each repetition beginning with another one, so that what disturbs
// the machine disturbs all.
#pragma once

#include <functional>
#include <vector>

namespace levelray {

struct TimeSpread {
  double median = 0, min = 0, max = 0; // nanoseconds of the process' processor time, all threads together
};

// Runs each once without counting, then `repetitions` times in rotated order. Stops where parallel loops
// would (core/parallel.hpp).
std::vector<TimeSpread> interleaved_times(const std::vector<std::function<void()>>& works, int repetitions);

} // namespace levelray
