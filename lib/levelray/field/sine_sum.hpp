// The first root of a sum of sines of linear functions, by interval halving with proofs.
#pragma once

#include "levelray/field/field.hpp"

#include <array>
#include <optional>

namespace levelray {

// h(t) = sum of amplitude * sin(phase_i + rate_i t), less a level.
struct SineSum {
  static constexpr std::size_t terms = 6;
  Extended amplitude = 0.5, level = 0;
  std::array<Extended, terms> phase{}, rate{};

  Extended value(Extended t) const;
  Extended slope(Extended t) const;
};

struct FirstRoot {
  std::optional<Extended> at; // where the sign first changes in [low, high]
  bool undecided = false;     // a place before it comes too close to zero to tell
};

// Around the middle m of an interval of half width w, |h(t) - h(m)| <= |h'(m)| w + M w^2 / 2 and |h'(t) -
// h'(m)|
// <= M w, with M = sum of amplitude * rate^2 >= |h''|: the first proves that there is no root, the second
// that there is one at the most, which signs at the ends then decide. Other intervals are halved, the left
// half first.
FirstRoot first_root(const SineSum& sum, Extended low, Extended high);

} // namespace levelray
