// What a normal scheme is asked, and what it answers.
//
// A scheme is a struct with
//   static constexpr std::string_view name, source;
//   static constexpr int samples, interpolations;   // how many it reads and does
//   static constexpr bool whole;   // it reads samples with two or three indices that are -1 or 2
//   static Vec3d gradient(const Neighbourhood&, const CellPosition&);
// the gradient in world units of value per voxel, whose length does not matter. It may be zero (a plateau, a
// ridge): `unit_normal` then falls back.
#pragma once

#include "levelray/grid/block_grid.hpp"

namespace levelray {

// A point of the interpolated surface: its cell, and its place in it.
struct CellPosition {
  Vec3i cell{0, 0, 0};
  double local[3] = {0, 0, 0}; // [0,1]
};

} // namespace levelray
