// Normals as a pass over hits.
#pragma once

#include "levelray/core/ray.hpp"
#include "levelray/trace/hit.hpp"

#include <span>
#include <string_view>

namespace levelray {

class LevelSet;

// The unit normals (world space, towards positive values, so outward) at the hits of rays, by the scheme of
// that name (normal/normals.hpp); (0,0,0) for misses. Throws Error(usage), naming the legal ones, for an
// unknown scheme.
void hit_normals(const LevelSet& level_set, std::span<const WorldRay> rays, std::span<const Hit> hits,
                 std::string_view scheme, std::span<Vec3f> normals);
// The samples and interpolations that a normal by that scheme takes.
RayCounts counts_of_normal(std::string_view scheme);
Vec3f hit_normal(const LevelSet& level_set, const WorldRay& ray, const Hit& hit,
                 std::string_view scheme = "interpolation-of-differences");

} // namespace levelray
