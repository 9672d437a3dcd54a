// Random and adversarial rays without end against the oracle; scripts/soak runs it.
//
//   soak [--rays N] [--seed S] [--method NAME] [--state FILE] [--threads T] [--chunk C]
//
// N may be written 1e9, and is rounded up to whole chunks. With a state file a run that was broken off goes
// on where it was; the counts depend on N, seed and method alone. The last line is the verdict
//   rays N  leaks L  phantoms P  wrong W  seconds S
// and the exit code 1 where `exact` has any of these, or a certificate that does not hold.
#include "levelray/core/methods.hpp"
#include "levelray/core/parallel.hpp"
#include "levelray/intersect/intersectors.hpp"
#include "soak/chunk.hpp"

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <mutex>
#include <string>

using namespace levelray;
using namespace levelray::test;

namespace {

struct Options {
  double rays = 1e6;
  std::uint64_t seed = 1;
  std::string method = "exact", state;
  int threads = 0;
  long chunk = -1;
};

int usage(const std::string& problem) {
  std::string methods;
  for (const std::string& name : method_names<Intersectors>()) methods += name + ", ";
  std::fprintf(
      stderr,
      "soak: %s\nusage: soak [--rays N] [--seed S] [--method NAME] [--state FILE] [--threads T] [--chunk C]\n"
      "methods: %sopenvdb\n",
      problem.c_str(), methods.c_str());
  return 2;
}

bool known(const std::string& method) {
  bool found = method == "openvdb";
  for (const std::string& name : method_names<Intersectors>()) found |= name == method;
  return found;
}

// Returns 0, or the exit code.
int parse(int argc, char** argv, Options& options) {
  for (int i = 1; i < argc; ++i) {
    const std::string name = argv[i];
    if (name == "--help") return usage("random and adversarial rays against an oracle"), 0;
    if (i + 1 == argc) return usage(name + " wants a value");
    const char* value = argv[++i];
    char* end = nullptr;
    if (name == "--rays")
      options.rays = std::strtod(value, &end);
    else if (name == "--seed")
      options.seed = std::strtoull(value, &end, 10);
    else if (name == "--threads")
      options.threads = static_cast<int>(std::strtol(value, &end, 10));
    else if (name == "--chunk")
      options.chunk = std::strtol(value, &end, 10);
    else if (name == "--method")
      options.method = value;
    else if (name == "--state")
      options.state = value;
    else
      return usage("unknown option " + name);
    if (end && (*end || end == value)) return usage(name + ": '" + value + "' is no number");
  }
  if (!(options.rays >= 1 && options.rays <= 1e15)) return usage("--rays takes 1 to 1e15");
  if (!known(options.method)) return usage("unknown method '" + options.method + "'");
  return 0;
}

void report(const std::string& method, const SoakState& state) {
  Tally tally = state.tally;
  std::printf("method %s", method.c_str());
  const auto counts = tally.counts();
  for (std::size_t i = 1; i < counts.size(); ++i)
    std::printf("  %s %llu", Tally::names()[i].c_str(), static_cast<unsigned long long>(*counts[i]));
  std::printf("\n|t - oracle| in voxels: p50 <= %.2g  p99 <= %.2g  p99.9 <= %.2g  max %.3g\n",
              quantile(tally.errors, 0.5), quantile(tally.errors, 0.99), quantile(tally.errors, 0.999),
              tally.largest_error);
  if (tally.certified)
    std::printf("certified bounds in voxels: p50 <= %.2g  p99 <= %.2g  p99.9 <= %.2g  max %.3g\n",
                quantile(tally.bounds, 0.5), quantile(tally.bounds, 0.99), quantile(tally.bounds, 0.999),
                tally.largest_bound);
  std::printf("rays %llu  leaks %llu  phantoms %llu  wrong %llu  seconds %.0f\n",
              static_cast<unsigned long long>(tally.rays), static_cast<unsigned long long>(tally.leaks),
              static_cast<unsigned long long>(tally.phantoms), static_cast<unsigned long long>(tally.wrong),
              state.seconds);
}

int run(const Options& options) {
  const ThreadLimit limit(options.threads);
  const auto chunks =
      static_cast<std::uint64_t>(std::ceil(options.rays / static_cast<double>(rays_per_chunk)));
  SoakState state;
  state.key = "levelray soak 1, method " + options.method + ", seed " + std::to_string(options.seed);
  if (!options.state.empty() && load(options.state, state))
    std::fprintf(stderr, "soak: going on after %llu rays\n",
                 static_cast<unsigned long long>(state.tally.rays));

  if (options.chunk >= 0) {
    state.tally = run_chunk(options.method, options.seed, static_cast<std::uint64_t>(options.chunk), true);
    report(options.method, state);
    return 0;
  }

  using Clock = std::chrono::steady_clock;
  auto told = Clock::now();
  constexpr std::uint64_t batch = 24; // chunks between two states: twice all shapes
  while (state.chunks < chunks) {
    const auto start = Clock::now();
    const std::uint64_t count = std::min(batch, chunks - state.chunks);
    std::mutex mutex;
    parallel_for(count, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const Tally tally =
            run_chunk(options.method, options.seed, state.chunks + i, options.method == "exact");
        const std::lock_guard lock(mutex);
        state.tally += tally;
      }
    });
    state.chunks += count;
    const auto now = Clock::now();
    state.seconds += std::chrono::duration<double>(now - start).count();
    if (!options.state.empty()) save(options.state, state);
    if (now - told > std::chrono::seconds(10)) {
      told = now;
      std::fprintf(
          stderr, "soak: %.3g of %.3g rays, %.0f per second, leaks %llu  phantoms %llu  wrong %llu\n",
          static_cast<double>(state.chunks * rays_per_chunk), static_cast<double>(chunks * rays_per_chunk),
          static_cast<double>(state.tally.rays) / state.seconds,
          static_cast<unsigned long long>(state.tally.leaks),
          static_cast<unsigned long long>(state.tally.phantoms),
          static_cast<unsigned long long>(state.tally.wrong));
    }
  }
  report(options.method, state);
  const Tally& t = state.tally;
  const std::uint64_t bad =
      t.leaks + t.phantoms + t.wrong + t.bracket_violations + t.bound_violations + t.parity_violations;
  return options.method == "exact" && bad != 0;
}

} // namespace

int main(int argc, char** argv) {
  Options options;
  if (const int code = parse(argc, argv, options)) return code;
  if (argc == 2 && std::strcmp(argv[1], "--help") == 0) return 0;
  try {
    return run(options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "soak: %s\n", error.what());
    return 3;
  }
}
