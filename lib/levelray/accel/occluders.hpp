// The inside of a closed surface, as shadow rays use it: whoever passes through it has crossed the surface.
//
// Source: Jamriska 2010, section 7, after the volumetric occluders of Djeu, Keely and Hunt 2009. The shortcut
// is right only where four things hold, which the paper leaves to the reader:
//  - the grid is closed and its signs are right: every block that is said to lie inside has only inside and
//    surface blocks for neighbours. This is checked here (`consistent`), for every pair of neighbours.
//  - the ray begins outside (`begins_outside`), by the value at its beginning that the plain walk looks at.
//  - the inside is met before the ray's end, by the times that the walks compute.
//  - what is inside is opaque, which only the caller knows.
// Then a walk finds a hit too, with any intersector: the samples on the faces of an inside block are
// negative, neighbouring cells agree bit for bit on the values of shared faces (grid/cell_segment.hpp), cells
// without their bit have one sign, and each intersector takes a change of sign between the ends of a cell for
// a hit. So answers are the same to the last bit.
//
// Boxes: besides the blocks, a few large boxes of inside blocks, grown from the largest inside cubes, that
// can be tried before any walk.
#pragma once

#include "levelray/accel/ray_frame.hpp"

#include <cstdint>
#include <vector>

namespace levelray {

class Occluders {
 public:
  static constexpr int most_boxes = 8;

  // In the table's blocks (SurfaceBlocks::block_min); `end` is excluded.
  struct Box {
    int low[3], end[3];
  };

  Occluders() = default;
  // Of that surface of that grid. The same for any number of threads.
  Occluders(const BlockGrid& grid, const SurfaceBlocks& surface);

  bool consistent() const { return consistent_; }
  // The inside blocks of a node of the surface's table, whether or not it has surface blocks.
  std::uint64_t inside(std::size_t entry) const { return inside_[entry]; }
  const std::vector<Box>& boxes() const { return boxes_; } // large ones first

  // Whether the ray begins where the value is not negative, at s = 0.
  bool begins_outside(const SurfaceBlocks& surface, const RayFrame& ray) const;

  std::size_t bytes() const { return inside_.size() * sizeof(std::uint64_t) + boxes_.size() * sizeof(Box); }

 private:
  bool check(const SurfaceBlocks& surface) const;
  void find_boxes(const SurfaceBlocks& surface);

  std::vector<std::uint64_t> inside_;
  std::vector<Box> boxes_;
  bool consistent_ = false;
};

// Whether the ray meets the box in [0, end].
bool meets(const SurfaceBlocks& surface, const RayFrame& ray, const Occluders::Box& box);

} // namespace levelray
