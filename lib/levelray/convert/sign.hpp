// From regions and windings to one bit per sample: inside or outside.
#pragma once

#include "levelray/convert/boundary_winding.hpp"
#include "levelray/convert/mesh_to_grid.hpp"
#include "levelray/convert/regions.hpp"

#include <vector>

namespace levelray {

// The sides of a node's samples: uniform, or one mask per block (bit set: inside).
struct NodeSides {
  bool inside = false;               // when uniform
  std::vector<std::uint64_t> blocks; // 64 masks, or empty: uniform

  bool uniform() const { return blocks.empty(); }
  std::uint64_t block(std::size_t b) const {
    return uniform() ? (inside ? ~std::uint64_t{0} : 0) : blocks[b];
  }
};

// Which lattice-edge counting a method needs.
SheetCounting counting_for(SignMethod method);

// The sides of all samples of table entry `n`. Never touches a distance.
NodeSides node_sides(const Band& band, const Regions& regions, const BoundaryWinding& boundary,
                     SignMethod method, std::size_t n);

} // namespace levelray
