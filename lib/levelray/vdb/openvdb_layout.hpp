// How OpenVDB's leaves and tiles lie in our nodes and blocks, and what their samples become; for
// from_openvdb.cpp.
#pragma once

#include "levelray/grid/block_grid.hpp"

#include <algorithm>
#include <openvdb/openvdb.h>

namespace levelray::openvdb_layout {

// A tile that is active or inside.
struct Tile {
  openvdb::CoordBBox box;
  float value;
  bool active;
};

// What the samples of a leaf become.
struct LeafSummary {
  std::uint8_t stored = 0, inside = 0; // octants: bit x + 2 y + 4 z
};

// What the values of a tree are like.
struct Statistics {
  std::uint64_t active = 0, odd_inactive = 0, zero_inactive = 0;
  float largest = 0; // |active value|
  bool negative = false, positive = false;
  bool bad = false; // a value that is not finite
  openvdb::Coord bad_at;

  void add(const Statistics& other) {
    active += other.active, odd_inactive += other.odd_inactive, zero_inactive += other.zero_inactive;
    largest = std::max(largest, other.largest);
    negative |= other.negative, positive |= other.positive;
    if (!bad && other.bad) bad = true, bad_at = other.bad_at;
  }
};

// A sample as ours.
struct Sample {
  float value;
  bool active;
};

// -0 becomes +0.
template <class Value>
float to_float(Value v) {
  return static_cast<float>(v) + 0.0f;
}

inline Sample convert(float value, bool active, float file_background, float background) {
  if (active) return {value, true};
  if (value == file_background || value == 0) return {background, false};
  if (value == -file_background) return {-background, false};
  return {value, true};
}

// The place in a leaf of sample s of the block that is octant `octant` of it; a leaf's values run z fastest.
inline openvdb::Index leaf_index(int octant, int s) {
  const int x = (octant & 1) * 4 + bit_x(s), y = (octant >> 1 & 1) * 4 + bit_y(s),
            z = (octant >> 2) * 4 + bit_z(s);
  return static_cast<openvdb::Index>(x << 6 | y << 3 | z);
}

inline Vec3i node_of(const openvdb::Coord& c) {
  return {c.x() >> 4, c.y() >> 4, c.z() >> 4};
}
inline bool whole_nodes(const Tile& t) {
  return t.box.dim().x() >= node_dim;
}

// Octants are numbered x + 2 y + 4 z: of a node (where a leaf lies), and of a leaf (where a block lies).
inline int octant_of(const openvdb::Coord& c) {
  return (c.x() >> 3 & 1) | (c.y() >> 3 & 1) << 1 | (c.z() >> 3 & 1) << 2;
}
// The bit in its node of a leaf's block.
inline int block_bit(int node_octant, int leaf_octant) {
  return (2 * (node_octant & 1) + (leaf_octant & 1)) |
         (2 * (node_octant >> 1 & 1) + (leaf_octant >> 1 & 1)) << 2 |
         (2 * (node_octant >> 2) + (leaf_octant >> 2)) << 4;
}
// The mask in its node of a leaf's blocks.
inline std::uint64_t octant_blocks(int octant, unsigned leaf_octants = 0xFF) {
  std::uint64_t mask = 0;
  for (int o = 0; o < 8; ++o)
    if (leaf_octants >> o & 1) mask |= std::uint64_t{1} << block_bit(octant, o);
  return mask;
}

// Calls visit(node coordinates, blocks of it) for the part of each node that the tile covers.
template <class Visit>
void for_nodes(const Tile& t, const Visit& visit) {
  const Vec3i low = node_of(t.box.min()), high = node_of(t.box.max());
  if (!whole_nodes(t)) { // 8^3 samples: an octant of a node
    visit(low, octant_blocks(octant_of(t.box.min())));
    return;
  }
  for (int z = low.z; z <= high.z; ++z)
    for (int y = low.y; y <= high.y; ++y)
      for (int x = low.x; x <= high.x; ++x) visit(Vec3i(x, y, z), ~std::uint64_t{0});
}

} // namespace levelray::openvdb_layout
