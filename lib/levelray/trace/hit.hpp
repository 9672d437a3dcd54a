// What a ray found.
#pragma once

#include "levelray/core/vec.hpp"

#include <cstdint>

namespace levelray {

enum class HitStatus : std::uint8_t {
  miss, // nothing in [t_min, t_max]
  hit   // the surface: entered from outside or, when the ray began inside, left
};

// Counters of a ray, or sums of them, as the paper counts (Jamriska 2010, Tables 1 to 4).
template <class T>
struct BasicCounts {
  // Leaping: nodes (or leaps over empty ones), surface blocks and surface cells visited. Stepping: blocks
  // and, in surface blocks, cells, with and without surface.
  T steps = 0;
  T tests = 0;          // surface cells whose interpolant was looked at
  T interpolations = 0; // values of trilinear interpolants, or of their blossoms, that were computed
  T samples = 0;        // of the grid that were read for that

  template <class U>
  BasicCounts& operator+=(const BasicCounts<U>& other) {
    steps += other.steps, tests += other.tests;
    interpolations += other.interpolations, samples += other.samples;
    return *this;
  }
};
using RayCounts = BasicCounts<std::uint32_t>;
using CountSums = BasicCounts<std::uint64_t>;

struct Hit {
  HitStatus status = HitStatus::miss;
  bool from_inside = false; // the ray began at a negative value; the hit is where it comes out
  double t = 0;             // along the ray's own direction
  double t_outside = 0; // the last point, before t, whose value is proven to lie safely on the ray's starting
                        // side: start secondary rays there, without an epsilon; the ray's beginning where
                        // there is no such point. The proof allows for the rounding of places
                        // up to 2^14 voxels away, and for samples next to the place's block that are up to
                        // 2^8 times as large as those in it; else f has to be looked at (field_probe.hpp)
  Vec3i cell{0, 0, 0};  // the cell that holds the hit
  RayCounts counts;

  explicit operator bool() const { return status == HitStatus::hit; }
};

} // namespace levelray
