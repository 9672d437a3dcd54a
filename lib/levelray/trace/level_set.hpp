// A level set ready for tracing: of a block grid, the blocks that the surface crosses, laid out for rays.
//
// Surface blocks carry their cell mask and a copy of the 5^3 samples that their 4^3 cells touch, so that a
// cell never looks beyond its block; nodes carry a mask of surface blocks and the distance to the nearest
// node that has any. Normals read the grid itself.
#pragma once

#include "levelray/core/ray.hpp"
#include "levelray/grid/block_grid.hpp"
#include "levelray/trace/hit.hpp"

#include <string_view>

namespace levelray {

class LevelSet {
 public:
  // Keeps a reference: the grid must outlive the level set. Builds all acceleration data from the grid's cell
  // masks.
  explicit LevelSet(const BlockGrid& grid);

  const BlockGrid& grid() const { return *grid_; }
  std::size_t bytes() const; // beyond the grid
                             // ... data (see trace/level_set.cpp)

 private:
  const BlockGrid* grid_;
};

// The surface's first crossing in [t_min, t_max] of a world-space ray, by the intersector of that name
// (intersect/intersectors.hpp). Any finite origin; any direction but zero, whose hit status is then `miss`;
// NaN anywhere is a miss; infinite intervals are fine.
Hit closest_hit(const LevelSet& level_set, const WorldRay& ray, std::string_view intersector = "exact");
// Whether there is such a crossing; may stop at the first proof of one.
bool any_hit(const LevelSet& level_set, const WorldRay& ray, std::string_view intersector = "exact",
             RayCounts* counts = nullptr);

} // namespace levelray
