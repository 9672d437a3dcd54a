// Fair timing: contestants take turns in one process, each repetition beginning with another one, so that
// what disturbs the machine disturbs all; what counts is the ratio within a repetition.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace levelray::bench {

// Milliseconds: wall clock, and processor time of all threads of this process.
struct Time {
  double wall = 0, cpu = 0;
};

class Stopwatch {
 public:
  Stopwatch();
  Time elapsed() const;

 private:
  Time start_;
};

struct Contestant {
  std::string name;
  std::function<Time()> run;    // does the work once and says what it took
  std::vector<Time> times = {}; // one per repetition
};

// Runs everyone once without counting, then `repetitions` times in rotated order.
void compete(std::vector<Contestant>& contestants, int repetitions);

struct Spread {
  double median = 0, min = 0, max = 0;
};
Spread spread(std::vector<double> values);
Spread wall(const Contestant& contestant);
Spread cpu(const Contestant& contestant);

// Per repetition the slow ones' processor time over the quick ones', each group's summed.
Spread cpu_ratio(const std::vector<const Contestant*>& slow, const std::vector<const Contestant*>& quick);
// The same of the wall clock.
Spread wall_ratio(const std::vector<const Contestant*>& slow, const std::vector<const Contestant*>& quick);

nlohmann::json to_json(const Spread& spread);
nlohmann::json to_json(const Contestant& contestant);

// Processor, threads, compiler, flags, libraries and the load at this moment.
nlohmann::json describe_machine();

} // namespace levelray::bench
