// THE conventions of samples, cells, blocks and nodes.
//
//   sample  (i,j,k)   integer index; its position in voxel space is (i,j,k), in world space origin +
//   voxel_size * (i,j,k) cell    (i,j,k)   the unit cube between the samples (i..i+1, j..j+1, k..k+1):
//   samples are the cell's corners block             4x4x4 samples whose lowest index is a multiple of 4; the
//   cells of a block have their lowest corners in it node              4x4x4 blocks, 16x16x16 samples whose
//   lowest index is a multiple of 16
//
// Bits of 64-bit masks, and values of a block, are ordered x fastest: bit = x + 4 y + 16 z, for samples or
// cells in a block and for blocks in a node alike. Indices may be negative; all divisions here are floor
// divisions (arithmetic shifts).
#pragma once

#include "levelray/core/vec.hpp"

#include <cstdint>

namespace levelray {

inline constexpr int block_dim = 4;
inline constexpr int node_dim = 16;
inline constexpr int samples_per_block = 64;

// The bit of a sample (or cell) in its block.
constexpr int bit_in_block(int i, int j, int k) {
  return (i & 3) | (j & 3) << 2 | (k & 3) << 4;
}
// The bit of the block of sample (i,j,k) in its node.
constexpr int bit_in_node(int i, int j, int k) {
  return (i >> 2 & 3) | (j >> 2 & 3) << 2 | (k >> 2 & 3) << 4;
}
// The x, y, z digits of such a bit.
constexpr int bit_x(int bit) {
  return bit & 3;
}
constexpr int bit_y(int bit) {
  return bit >> 2 & 3;
}
constexpr int bit_z(int bit) {
  return bit >> 4 & 3;
}

// Uniform scale and translation between voxel space and world space.
struct GridTransform {
  Vec3d origin{0, 0, 0}; // world position of sample (0,0,0)
  double voxel_size = 1; // world units, > 0

  Vec3d to_world(const Vec3d& voxel) const { return origin + voxel * voxel_size; }
  Vec3d to_voxel(const Vec3d& world) const { return (world - origin) / voxel_size; }
};

} // namespace levelray
