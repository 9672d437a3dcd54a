// Which samples of a block lie on the same side of the surface, and by how much the winding number differs
// between the sides.
//
// Two neighbouring samples are LINKED when the sum of their distances to the surface exceeds the distance
// between them: the two balls that hold no surface then cover the segment between them, so the winding number
// is the same at both, whatever the surface is. The connected components of links are the regions whose sign
// is decided at once; what the links leave apart is joined by counting, exactly, what a lattice edge crosses.
#pragma once

#include "levelray/convert/crossing.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace levelray {

// d_i + d_j must exceed this for a link: 1 is the theorem; the distances err by less than 1e-5 each (see
// README.md), and the fixed-point vertices of the crossing tests by less than 1e-5 more.
inline constexpr float link_threshold = 1.0f + 4e-5f;

enum class SheetCounting {
  none,     // links only
  windings, // components are joined by signed crossings: one potential for all of them
  touching  // neighbouring samples are linked also when no triangle lies between them
};

// A set of samples of one block with one winding number.
struct BlockComponent {
  std::uint64_t samples = 0;
  std::int32_t winding = 0; // relative to its node component
  std::uint32_t node_component = 0;
};

// What lies between a block and its neighbour at +axis where links alone might not join them.
struct FaceCrossing {
  std::uint16_t free =
      0; // of the 16 lattice edges across the face, those that cross nothing (only when `touching`)
  std::int32_t winding = 0; // along the edge from the face's lowest sample, when `tested`
  bool tested = false;
};

// The 16 samples of a block's face at the low (0) or high (1) end of an axis, as bits.
std::uint64_t face_samples(int axis, int end);

// Appends the components of a block of 64 unsigned distances (voxels; 16 more floats may be read) to the
// sheets, ordered by lowest sample, with windings relative to the first of them; list[0..count) holds every
// triangle that meets the block's samples' box or a lattice edge from it. Returns at how many places the
// surface was seen to cross an edge twice without a change of side: it is thinner than a voxel there.
int find_block_components(const float* distance, const VoxelMesh& mesh, std::span<const std::uint32_t> list,
                          const Vec3i& first_sample, SheetCounting counting,
                          std::vector<BlockComponent>& out);

// The crossing of a block's high face along `axis`; `distance` as above.
FaceCrossing find_face_crossing(const float* distance, const VoxelMesh& mesh,
                                std::span<const std::uint32_t> list, const Vec3i& first_sample, int axis,
                                SheetCounting counting);

// A block for joining: its distances to the sheets (null: all are larger than the link threshold) and its
// components.
struct BlockSide {
  const float* distance = nullptr;
  std::span<const BlockComponent> components;
};

} // namespace levelray
