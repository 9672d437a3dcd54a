// The one list of intersectors; command line, documentation, instantiations and tests come from it.
#pragma once

#include "levelray/core/methods.hpp"
#include "levelray/intersect/exact.hpp"
#include "levelray/intersect/false_position.hpp"
#include "levelray/intersect/midpoint.hpp"

namespace levelray {

using Intersectors =
    std::tuple<Exact, Midpoint, FalsePosition<1>, FalsePosition<2>, FalsePosition<3>, FalsePosition<4>>;

// `false-position` is short for one step of it, the paper's choice for all its later tests; other names stay.
constexpr std::string_view canonical_intersector(std::string_view name) {
  return name == "false-position" ? FalsePosition<1>::name : name;
}

} // namespace levelray
