// The regions that the surface cuts space into, over the whole grid.
#pragma once

#include "levelray/convert/binning.hpp"
#include "levelray/convert/node_band.hpp"

#include <vector>

namespace levelray {

// The bands of the touched nodes, and where they are.
struct Band {
  static constexpr std::int32_t untouched = -1;

  NodeBox box;                       // has at least one untouched node around all touched ones
  std::vector<std::int32_t> node_at; // per table entry: index into `nodes`, or untouched
  std::vector<NodeBand> nodes;
};

// Regions by id: an untouched node has one, a touched node one per node component.
struct Regions {
  std::vector<std::uint32_t> first_id; // per table entry
  std::vector<std::uint32_t> set;      // per id: regions with the same set are connected
  std::vector<std::int32_t> winding;   // per id: relative to the set's root
  std::uint32_t outer_set = 0;         // the set of what lies beyond the grid
  std::int32_t outer_winding = 0;      // the winding (relative to the root) of that
  std::vector<std::int64_t> votes;     // per set: of its components, when they voted
  std::uint64_t contradictions = 0;    // joins that disagreed: never for chains without boundary

  bool connected_to_outside(std::uint32_t id) const { return set[id] == outer_set; }
  // The winding number of a region that is connected to the outside, of mesh and caps together.
  std::int32_t winding_number(std::uint32_t id) const { return winding[id] - outer_winding; }
};

Regions join_regions(const Band& band, SheetCounting counting);

} // namespace levelray
