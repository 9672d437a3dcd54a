// What a ray found.
#pragma once

#include "levelray/core/vec.hpp"

#include <cstdint>

namespace levelray {

enum class HitStatus : std::uint8_t {
  miss, // nothing in [t_min, t_max]
  hit   // the surface: entered from outside or, when the ray began inside, left
};

// Counters of one ray, as the paper counts them (Jamriska 2010, Tables 3 and 4).
struct RayCounts {
  std::uint32_t steps = 0; // nodes (or leaps over empty ones), surface blocks and surface cells visited
  std::uint32_t tests = 0; // cells whose interpolant was looked at
};

struct Hit {
  HitStatus status = HitStatus::miss;
  bool from_inside = false; // the ray began at a negative value; the hit is where it comes out
  double t = 0;             // along the ray's own direction
  double t_outside = 0; // the last point, before t, whose value is proven to lie safely on the ray's starting
                        // side: start secondary rays there, without an epsilon; the ray's beginning where
                        // there is no such point
  Vec3i cell{0, 0, 0};  // the cell that holds the hit
  RayCounts counts;

  explicit operator bool() const { return status == HitStatus::hit; }
};

} // namespace levelray
