#include "levelray/field/sine_sum.hpp"

namespace levelray {

Extended SineSum::value(Extended t) const {
  Extended sum = 0;
  for (std::size_t i = 0; i < terms; ++i) sum += std::sin(phase[i] + rate[i] * t);
  return amplitude * sum - level;
}

Extended SineSum::slope(Extended t) const {
  Extended sum = 0;
  for (std::size_t i = 0; i < terms; ++i) sum += rate[i] * std::cos(phase[i] + rate[i] * t);
  return amplitude * sum;
}

namespace {

struct Search {
  const SineSum& sum;
  Extended bend = 0;     // M
  Extended rounding = 0; // of a value
  Extended least = 0;    // half widths below are given up
  bool undecided = false;

  std::optional<Extended> find(Extended low, Extended high) {
    const Extended middle = (low + high) / 2, half = (high - low) / 2;
    const Extended value = sum.value(middle), slope = std::fabs(sum.slope(middle));
    if (std::fabs(value) - slope * half - bend * half * half / 2 > rounding) return {};
    if (slope - bend * half > 0) { // monotone
      const Extended a = sum.value(low), b = sum.value(high);
      if (std::fabs(a) > rounding && std::fabs(b) > rounding) {
        if (std::signbit(a) == std::signbit(b)) return {};
        return bisect(low, high, std::signbit(a));
      }
    }
    if (half < least) {
      undecided = true;
      return {};
    }
    if (const auto root = find(low, middle)) return root;
    if (undecided) return {};
    return find(middle, high);
  }

  Extended bisect(Extended low, Extended high, bool negative) const {
    for (int step = 0; step < 70; ++step) {
      const Extended middle = (low + high) / 2;
      (std::signbit(sum.value(middle)) == negative ? low : high) = middle;
    }
    return high;
  }
};

} // namespace

FirstRoot first_root(const SineSum& sum, Extended low, Extended high) {
  if (!(low < high)) return {};
  Search search{sum};
  Extended largest = 0;
  for (std::size_t i = 0; i < SineSum::terms; ++i) {
    search.bend += sum.amplitude * sum.rate[i] * sum.rate[i];
    largest = std::max(largest, std::fabs(sum.phase[i]) +
                                    std::fabs(sum.rate[i]) * std::max(std::fabs(low), std::fabs(high)));
  }
  // Arguments are off by 2^-63 of the largest, sines by that and their own rounding.
  search.rounding = sum.amplitude * SineSum::terms * 0x1p-62L * (1 + largest);
  search.least = 0x1p-44L * (high - low);
  FirstRoot result;
  result.at = search.find(low, high);
  result.undecided = search.undecided;
  return result;
}

} // namespace levelray
