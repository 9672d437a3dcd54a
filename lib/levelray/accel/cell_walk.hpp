// Visits the surface cells along a ray, front to back.
//
// Source: the two-level traversal with cell masks of Jamriska 2010, section 4.1, after Amanatides and Woo
// 1987. Ours differs: three levels (nodes 16^3, blocks 4^3, cells); empty nodes are left by leaps over the
// largest empty cube ahead; inside a node and a block there is no stepping: the children that the chord can
// meet are cut out of the 64-bit mask, and each is tested against its slabs. In the mirrored frame
// coordinates only grow along a ray, so a child that is met later has no smaller digit, and ascending bits
// are an order from front to back.
//
// Times. s of a plane is always (plane - origin) * inverse from the integer plane, so it is monotone in the
// plane, all levels agree on shared planes, and nothing accumulates. A child's interval [in, out] is closed:
// the largest of three lower and the smallest of three upper planes, cut to [0, end]. Closed intervals of
// children with shared planes cover the whole chord whatever rounding does, so a tie at an edge or corner
// adds a visit of length zero and never loses one.
//
// No leaks. Neighbours across a face, an edge or a corner share samples, so cells whose bits are clear cannot
// be positive on one and negative on the other side of a visited cell without that cell's interpolant having
// both signs at `in` and `out`: their coordinates on the crossed faces are exactly 0 or 1, the others are
// clamped to [0,1], and the interpolation is exact at its ends.
#pragma once

#include "levelray/accel/box_masks.hpp"
#include "levelray/accel/node_walk.hpp"
#include "levelray/accel/visited_cell.hpp"
#include "levelray/core/bits.hpp"

#include <bit>

namespace levelray {

namespace walk {

// A superset of the children of the box at `corner` that the ray meets in [in, out], an interval in which it
// is in the box: those between the children of the ends. The margin of 2^-20 children covers the rounding of
// the points against that of the plane times, which is below 2^-28 voxel in a box of 2^22 voxels.
[[gnu::always_inline]] inline std::uint64_t chord_mask(const RayFrame& ray, const int (&corner)[3],
                                                       double per_child, double in, double out) {
  std::uint64_t mask = ~std::uint64_t{0};
  for (int a = 0; a < 3; ++a) {
    const double first = (ray.origin[a] + in * ray.direction[a] - corner[a]) * per_child - 0x1p-20;
    const double last = (ray.origin[a] + out * ray.direction[a] - corner[a]) * per_child + 0x1p-20;
    // Truncation takes what is barely below 0 to 0; clamp as integers, which needs no branch.
    const int low = std::clamp(static_cast<int>(first), 0, 3),
              high = std::clamp(static_cast<int>(last), 0, 3);
    mask &= layer_masks[static_cast<std::size_t>(a)][static_cast<std::size_t>(low)]
                       [static_cast<std::size_t>(high)];
  }
  return mask;
}

} // namespace walk

// Calls visit(cell) for every surface cell that the ray meets, front to back, until it returns true. Returns
// whether it did. Begins and ends where skip_empty_nodes and narrow_frame, if they were called, have moved
// the ray's beginning and end to.
template <class Visit>
bool walk_cells(const SurfaceBlocks& surface, const RayFrame& ray, WalkCounts& counts, Visit&& visit) {
  const walk::NodeTable table(surface, ray.octant);
  const walk::CellReader reader(ray.octant);
  const int mirrored_bits = walk::mirrored_bits(ray.octant);

  VisitedCell cell;
  const auto visit_block = [&](std::size_t block, const int(&corner)[3], double in, double out) {
    ++counts.blocks;
    std::uint64_t rest =
        mirror_mask(surface.cells(block), ray.octant) & walk::chord_mask(ray, corner, 1, in, out);
    if (!rest) return false;
    const float* const record = surface.record(block);
    for (int line = 0; line < 8; ++line) __builtin_prefetch(record + 16 * line);
    const walk::PlaneTimes times(ray, corner, 1);
    for (; rest; rest &= rest - 1) {
      const int bit = std::countr_zero(rest);
      const int digit[3] = {bit_x(bit), bit_y(bit), bit_z(bit)};
      cell.in = times.in(digit[0], digit[1], digit[2], 0);
      cell.out = times.out(digit[0], digit[1], digit[2], ray.end);
      if (!(cell.in <= cell.out)) continue;
      ++counts.cells;
      reader.read(ray, times, corner, digit, record, cell);
      if (visit(static_cast<const VisitedCell&>(cell))) return true;
    }
    return false;
  };

  const auto visit_node = [&](const SurfaceBlocks::Node& node, const int(&corner)[3], double in, double out) {
    std::uint64_t rest = mirror_mask(node.blocks, ray.octant) & walk::chord_mask(ray, corner, 0.25, in, out);
    if (!rest) return false;
    const walk::PlaneTimes times(ray, corner, block_dim);
    for (; rest; rest &= rest - 1) {
      const int bit = std::countr_zero(rest);
      const double block_in = times.in(bit_x(bit), bit_y(bit), bit_z(bit), 0);
      const double block_out = times.out(bit_x(bit), bit_y(bit), bit_z(bit), ray.end);
      if (!(block_in <= block_out)) continue;
      const int block_corner[3] = {corner[0] + block_dim * bit_x(bit), corner[1] + block_dim * bit_y(bit),
                                   corner[2] + block_dim * bit_z(bit)};
      const std::uint64_t below = (std::uint64_t{1} << (bit ^ mirrored_bits)) - 1;
      if (visit_block(node.first + count_bits(node.blocks & below), block_corner, block_in, block_out))
        return true;
    }
    return false;
  };

  int at[3] = {ray.start_node[0], ray.start_node[1], ray.start_node[2]};
  double s = ray.start;
  counts.nodes += ray.skipped;
  for (;;) {
    ++counts.nodes;
    const std::size_t entry = table.entry(at);
    const int leap = table.leaps[entry];
    const int length = leap ? leap : 1;
    const walk::NodeExit exit(ray, at, length, s);
    if (!leap) {
      const int corner[3] = {at[0] * node_dim, at[1] * node_dim, at[2] * node_dim};
      if (visit_node(surface.node(entry), corner, s, std::min(exit.s, ray.end))) return true;
    }
    if (!exit.move(ray, table, length, at)) return false;
    s = exit.s;
  }
}

} // namespace levelray
