// The one list of intersectors; command line, documentation, instantiations and tests come from it.
#pragma once

#include "levelray/core/methods.hpp"
#include "levelray/intersect/exact.hpp"
#include "levelray/intersect/false_position.hpp"
#include "levelray/intersect/marmitt.hpp"
#include "levelray/intersect/midpoint.hpp"
#include "levelray/intersect/newton.hpp"
#include "levelray/intersect/sphere_tracing.hpp"

namespace levelray {

using Intersectors = std::tuple<Exact, Midpoint, FalsePosition<1>, FalsePosition<2>, FalsePosition<3>,
                                FalsePosition<4>, Marmitt, Newton, SphereTracing>;

// `false-position` is short for one step of it, the paper's choice for all its later tests; other names stay.
constexpr std::string_view canonical_intersector(std::string_view name) {
  return name == "false-position" ? FalsePosition<1>::name : name;
}

} // namespace levelray
