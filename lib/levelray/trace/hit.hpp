// What a ray found.
#pragma once

#include "levelray/core/vec.hpp"

#include <cstdint>

namespace levelray {

enum class HitStatus : std::uint8_t {
  miss,  // nothing in [t_min, t_max]
  hit,   // the surface, entered from outside (or left, when the ray began inside)
  inside // the ray begins at a point whose value is <= 0 and asked to be told (see TraceOptions)
};

// Counters of one ray, as the paper counts them (Jamriska 2010, Tables 3 and 4).
struct RayCounts {
  std::uint32_t steps = 0; // nodes, blocks and cells visited
  std::uint32_t tests = 0; // cells whose interpolant was looked at
};

struct Hit {
  HitStatus status = HitStatus::miss;
  double t = 0;         // along the ray's own direction
  double t_outside = 0; // the end of the last bracket that is proven to lie on the ray's starting side: start
                        // secondary rays here
  Vec3i cell{0, 0, 0};  // the cell that holds the hit
  RayCounts counts;

  explicit operator bool() const { return status == HitStatus::hit; }
};

} // namespace levelray
