// What a soak counts. Sums and maxima only, so the order of the chunks does not matter.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace levelray::test {

struct Tally {
  // In the order of `names()`.
  std::uint64_t rays = 0;
  std::uint64_t hits = 0;       // of the oracle
  std::uint64_t exactly = 0;    // rays that the oracle decided with exact numbers
  std::uint64_t leaks = 0;      // the oracle hits, the method does not
  std::uint64_t phantoms = 0;   // the method hits, the oracle does not
  std::uint64_t wrong = 0;      // both hit, but the method another root, or nothing within a cell's diagonal
  std::uint64_t doubtful = 0;   // they differ, but f comes only within rounding of 0 where they do: touches
  std::uint64_t certified = 0;  // hits whose signs at t_lo and t_hi the oracle looked at
  std::uint64_t grazes = 0;     // hits that certify calls grazes
  std::uint64_t beginnings = 0; // and beginnings
  std::uint64_t bracket_violations = 0; // f(t_lo) > 0 >= f(t_hi) is not so
  std::uint64_t bound_violations = 0; // |t - oracle| > the bound, or a proof of nothing where there is a root
  std::uint64_t parity_violations = 0; // all_hits' crossings against the signs at the ends
  // |t - oracle| in voxels, by eighths of powers of two from 2^-60 on; all hits that are not wrong or
  // doubtful.
  std::array<std::uint64_t, 520> errors{};
  double largest_error = 0;
  std::array<std::uint64_t, 520> bounds{}; // the certified bounds, likewise
  double largest_bound = 0;

  static const std::vector<std::string>& names();
  std::array<std::uint64_t*, 13> counts();
  Tally& operator+=(const Tally& other);
  void add_error(double voxels);
  void add_bound(double voxels);
};

// The least upper edge of the histogram that `fraction` of its entries lie under; 0 if it is empty.
double quantile(const std::array<std::uint64_t, 520>& histogram, double fraction);

// A soak's progress on disk, written to a temporary file and renamed.
struct SoakState {
  std::string key; // of method, seed and version: who resumes must have the same
  std::uint64_t chunks = 0;
  double seconds = 0;
  Tally tally;
};
// False where there is none; throws std::runtime_error where it is another soak's or damaged.
bool load(const std::string& path, SoakState& state);
void save(const std::string& path, const SoakState& state);

} // namespace levelray::test
