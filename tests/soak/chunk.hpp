// One chunk of a soak: a shape, some tens of thousands of rays, and their verdicts.
#pragma once

#include "soak/tally.hpp"

#include <cstdint>
#include <string>

namespace levelray::test {

inline constexpr std::uint64_t rays_per_chunk = 20000;

// `method`: an intersector's name, or "openvdb" for its LevelSetRayIntersector on the same grid, which is
// asked only rays that begin outside of the band. Failures are told to stderr, the first few of a chunk, when
// `verbose`. Depends on its arguments alone.
Tally run_chunk(const std::string& method, std::uint64_t seed, std::uint64_t chunk, bool verbose);

} // namespace levelray::test
