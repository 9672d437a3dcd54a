// All places where a ray meets the surface, not just the first: for thickness, solids, and counting.
//
// The same walk over the same cells as closest_hit, whose hit by `exact` is the first place, bit for bit. The
// sign of f is carried along the ray as a state; a place is where the state changes, so the number of
// crossings is odd exactly when the signs of f at the ends differ, whatever rounding does on the way.
#pragma once

#include "levelray/core/ray.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace levelray {

class LevelSet;

enum class PlaceKind : std::uint8_t {
  enters, // f goes from positive to negative
  leaves, // from negative to positive
  touch   // f comes to 0 and goes back to the side it came from; or is 0 at the ray's beginning or end. No
          // crossing. Where f stays 0 for a while, the beginning of that
};

struct SurfacePlace {
  double t = 0; // of the ray, ascending
  PlaceKind kind = PlaceKind::touch;
  Vec3i cell{0, 0, 0};
};

// Which sides the ends of a ray's interval lie on: +1 outside, -1 inside. 0: on the surface itself (last), or
// never off it (both). A ray that begins on the surface has the side that it goes to.
struct EndSides {
  int first = 1, last = 1;
};

// Puts all places in [t_min, t_max] into `places`, in their order. Rays as for closest_hit; those that are
// none (no direction, NaN, an empty interval) have no places and sides +1.
EndSides all_hits(const LevelSet& level_set, const WorldRay& ray, std::vector<SurfacePlace>& places);

// The last of them, without storing the others.
std::optional<SurfacePlace> farthest_hit(const LevelSet& level_set, const WorldRay& ray);

} // namespace levelray
