// closest_hit and any_hit: the doors through which all rays go.
//
// The surface is the zero level of the trilinear interpolant of the grid's samples. A ray that begins outside
// (f > 0) reports the first t in [t_min, t_max] with f <= 0, be it a crossing or a touch; one that begins
// inside (f < 0) the first t with f >= 0; one that begins on the surface its beginning. Intervals are closed.
//
// Any direction of 2^-960 to 2^1000 voxels; its t is in units of that length. Infinite t_min and t_max are
// fine, and so is an interval that begins before 0. A direction that is zero, infinite or beyond those
// lengths, t_min > t_max, or a NaN anywhere is a miss. No ray makes these functions hang or throw, but for an
// unknown intersector.
#pragma once

#include "levelray/core/ray.hpp"
#include "levelray/trace/hit.hpp"

#include <span>
#include <string_view>

namespace levelray {

class LevelSet;

// By the intersector of that name (intersect/intersectors.hpp, or `false-position`, short for its first). All
// throw Error(usage), naming the legal ones, where there is none; none looks the name up per ray but the
// first and the last.
Hit closest_hit(const LevelSet& level_set, const WorldRay& ray, std::string_view intersector = "exact");
void closest_hits(const LevelSet& level_set, std::span<const WorldRay> rays, std::string_view intersector,
                  std::span<Hit> hits);

// Whether closest_hit would find a hit; stops at the first proof of one. `counts` may be null.
void any_hits(const LevelSet& level_set, std::span<const WorldRay> rays, std::string_view intersector,
              std::span<bool> hits, RayCounts* counts = nullptr);
bool any_hit(const LevelSet& level_set, const WorldRay& ray, std::string_view intersector = "exact",
             RayCounts* counts = nullptr);

// The same for an intersector known at compile time; instantiated for the list.
template <class Intersector>
Hit trace_closest(const LevelSet& level_set, const WorldRay& ray);
template <class Intersector>
bool trace_any(const LevelSet& level_set, const WorldRay& ray, RayCounts& counts);

} // namespace levelray
