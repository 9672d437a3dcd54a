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
//
// Hosts may flush denormals, which changes no bit of hits but where samples are denormal themselves, and
// round as they like: hits are right, by twice the rounding.
#pragma once

#include "levelray/accel/minmax_buffer.hpp"
#include "levelray/accel/occluders.hpp"
#include "levelray/core/ray.hpp"
#include "levelray/trace/hit.hpp"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace levelray {

class LevelSet;

// How rays find their cells. The answers are the same to the last bit, but for the counts of steps.
enum class Traversal : std::uint8_t {
  leaps, // masks of nodes and blocks, and leaps over empty space (accel/cell_walk.hpp)
  plain  // the paper's: block by block, cell by cell (accel/plain_walk.hpp)
};
const std::vector<std::string>& traversal_names(); // in the order of the values

struct PrimaryOptions {
  std::string_view intersector = "exact";
  Traversal traversal = Traversal::leaps;
  // Per ray, or none: where it can meet the surface, as a MinMaxBuffer says. Changes no answer, saves steps.
  std::span<const RayBounds> bounds = {};
};

// How rays that ask for any hit are spared work (accel/occluders.hpp). The answers are the same.
enum class ShadowScheme : std::uint8_t {
  plain,    // they walk as others do
  occluder, // the paper's: they look ahead through some blocks for the inside, then walk (occluder_walk.hpp)
  boxes     // they try a few large boxes of the inside, then walk
};
const std::vector<std::string>& shadow_scheme_names(); // in the order of the values

struct ShadowOptions {
  std::string_view intersector = "exact";
  Traversal traversal = Traversal::leaps;
  ShadowScheme scheme = ShadowScheme::plain;
  int occluder_steps = 12;              // n of the paper: blocks looked at behind the first with surface
  const Occluders* occluders = nullptr; // of the level set; without, or where not consistent, rays go plainly
};

void closest_hits(const LevelSet& level_set, std::span<const WorldRay> rays, const PrimaryOptions& options,
                  std::span<Hit> hits);
// Whether closest_hits would find hits. `counts`, per ray, may be empty.
void any_hits(const LevelSet& level_set, std::span<const WorldRay> rays, const ShadowOptions& options,
              std::span<bool> hits, std::span<RayCounts> counts);

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
