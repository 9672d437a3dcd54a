#include "soak/tally.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iomanip>
#include <stdexcept>

namespace levelray::test {

namespace {

std::size_t bin_of(double voxels) {
  if (!(voxels > 0x1p-60)) return 0;
  return std::min<std::size_t>(519, static_cast<std::size_t>((std::log2(voxels) + 60) * 8) + 1);
}

} // namespace

const std::vector<std::string>& Tally::names() {
  static const std::vector<std::string> list{"rays",
                                             "hits",
                                             "exactly",
                                             "leaks",
                                             "phantoms",
                                             "wrong",
                                             "doubtful",
                                             "certified",
                                             "grazes",
                                             "beginnings",
                                             "bracket_violations",
                                             "bound_violations",
                                             "parity_violations"};
  return list;
}

std::array<std::uint64_t*, 13> Tally::counts() {
  return {&rays,
          &hits,
          &exactly,
          &leaks,
          &phantoms,
          &wrong,
          &doubtful,
          &certified,
          &grazes,
          &beginnings,
          &bracket_violations,
          &bound_violations,
          &parity_violations};
}

Tally& Tally::operator+=(const Tally& other) {
  Tally copy = other;
  const auto mine = counts(), others = copy.counts();
  for (std::size_t i = 0; i < mine.size(); ++i) *mine[i] += *others[i];
  for (std::size_t i = 0; i < errors.size(); ++i) errors[i] += other.errors[i], bounds[i] += other.bounds[i];
  largest_error = std::max(largest_error, other.largest_error);
  largest_bound = std::max(largest_bound, other.largest_bound);
  return *this;
}

void Tally::add_error(double voxels) {
  ++errors[bin_of(voxels)];
  largest_error = std::max(largest_error, voxels);
}

void Tally::add_bound(double voxels) {
  ++bounds[bin_of(voxels)];
  largest_bound = std::max(largest_bound, voxels);
}

double quantile(const std::array<std::uint64_t, 520>& histogram, double fraction) {
  std::uint64_t all = 0, under = 0;
  for (const std::uint64_t n : histogram) all += n;
  if (!all) return 0;
  for (std::size_t bin = 0; bin < histogram.size(); ++bin) {
    under += histogram[bin];
    if (static_cast<double>(under) >= fraction * static_cast<double>(all))
      return std::exp2(static_cast<double>(bin) / 8 - 60);
  }
  return std::exp2(5);
}

bool load(const std::string& path, SoakState& state) {
  std::ifstream file(path);
  if (!file) return false;
  std::string key, end;
  std::getline(file, key);
  if (key != state.key) throw std::runtime_error(path + ": is the state of another soak ('" + key + "')");
  file >> state.chunks >> state.seconds;
  for (std::uint64_t* count : state.tally.counts()) file >> *count;
  file >> state.tally.largest_error >> state.tally.largest_bound;
  for (std::uint64_t& n : state.tally.errors) file >> n;
  for (std::uint64_t& n : state.tally.bounds) file >> n;
  file >> end;
  if (!file || end != "end") throw std::runtime_error(path + ": is damaged; remove it to begin anew");
  return true;
}

void save(const std::string& path, const SoakState& state) {
  const std::string temporary = path + ".new";
  {
    std::ofstream file(temporary);
    file << state.key << '\n' << state.chunks << ' ' << std::setprecision(17) << state.seconds << '\n';
    Tally tally = state.tally;
    for (const std::uint64_t* count : tally.counts()) file << *count << ' ';
    file << '\n' << tally.largest_error << ' ' << tally.largest_bound << '\n';
    for (const std::uint64_t n : tally.errors) file << n << ' ';
    file << '\n';
    for (const std::uint64_t n : tally.bounds) file << n << ' ';
    file << "\nend\n";
    file.flush();
    if (!file) throw std::runtime_error(temporary + ": cannot write");
  }
  if (std::rename(temporary.c_str(), path.c_str()) != 0) throw std::runtime_error(path + ": cannot rename");
}

} // namespace levelray::test
