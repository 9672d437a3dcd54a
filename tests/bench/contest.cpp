#include "bench/contest.hpp"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <openvdb/version.h>
#include <thread>

namespace levelray::bench {

namespace {

Time now() {
  timespec cpu{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &cpu);
  const auto wall = std::chrono::steady_clock::now().time_since_epoch();
  return {std::chrono::duration<double, std::milli>(wall).count(),
          static_cast<double>(cpu.tv_sec) * 1e3 + static_cast<double>(cpu.tv_nsec) * 1e-6};
}

Spread ratio(const std::vector<const Contestant*>& slow, const std::vector<const Contestant*>& quick,
             double Time::*clock) {
  std::vector<double> ratios;
  for (std::size_t r = 0; r < slow.front()->times.size(); ++r) {
    double a = 0, b = 0;
    for (const Contestant* c : slow) a += c->times[r].*clock;
    for (const Contestant* c : quick) b += c->times[r].*clock;
    ratios.push_back(a / b);
  }
  return spread(ratios);
}

Spread of(const Contestant& contestant, double Time::*clock) {
  std::vector<double> values;
  for (const Time& time : contestant.times) values.push_back(time.*clock);
  return spread(values);
}

} // namespace

Stopwatch::Stopwatch() : start_(now()) {}

Time Stopwatch::elapsed() const {
  const Time end = now();
  return {end.wall - start_.wall, end.cpu - start_.cpu};
}

void compete(std::vector<Contestant>& contestants, int repetitions) {
  for (Contestant& c : contestants) c.run();
  for (int r = 0; r < repetitions; ++r)
    for (std::size_t i = 0; i < contestants.size(); ++i) {
      Contestant& c = contestants[(i + static_cast<std::size_t>(r)) % contestants.size()];
      c.times.push_back(c.run());
    }
}

Spread spread(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return {(values[(n - 1) / 2] + values[n / 2]) / 2, values.front(), values.back()};
}

Spread wall(const Contestant& contestant) {
  return of(contestant, &Time::wall);
}
Spread cpu(const Contestant& contestant) {
  return of(contestant, &Time::cpu);
}
Spread cpu_ratio(const std::vector<const Contestant*>& slow, const std::vector<const Contestant*>& quick) {
  return ratio(slow, quick, &Time::cpu);
}
Spread wall_ratio(const std::vector<const Contestant*>& slow, const std::vector<const Contestant*>& quick) {
  return ratio(slow, quick, &Time::wall);
}

nlohmann::json to_json(const Spread& s) {
  return {{"median", s.median}, {"min", s.min}, {"max", s.max}};
}

nlohmann::json to_json(const Contestant& contestant) {
  return {{"name", contestant.name},
          {"repetitions", contestant.times.size()},
          {"wall_ms", to_json(wall(contestant))},
          {"cpu_ms", to_json(cpu(contestant))}};
}

nlohmann::json describe_machine() {
  std::string processor = "unknown";
  std::ifstream cpuinfo("/proc/cpuinfo");
  for (std::string line; std::getline(cpuinfo, line);)
    if (line.rfind("model name", 0) == 0 && line.find(": ") != std::string::npos) {
      processor = line.substr(line.find(": ") + 2);
      break;
    }
  double load = 0;
  if (::getloadavg(&load, 1) != 1) load = -1;
  return {{"processor", processor},
          {"hardware_threads", std::thread::hardware_concurrency()},
          {"compiler",
#ifdef __clang__
           __VERSION__
#else
           "gcc " __VERSION__
#endif
          },
          {"flags", LEVELRAY_BENCH_FLAGS},
          {"openvdb", OPENVDB_LIBRARY_VERSION_STRING},
          {"load_average", load}};
}

} // namespace levelray::bench
