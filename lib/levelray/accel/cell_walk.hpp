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
#include "levelray/accel/ray_frame.hpp"
#include "levelray/core/bits.hpp"
#include "levelray/grid/cell_segment.hpp"

#include <bit>

namespace levelray {

struct WalkCounts {
  std::uint32_t nodes = 0, blocks = 0, cells = 0;
};

struct VisitedCell {
  CellSegment segment;
  double in, out;  // s
  int position[3]; // in cells of the frame
};

namespace walk {

// s of the five planes that bound and divide a 4x4x4 box, per axis.
struct PlaneTimes {
  double s[3][6]; // the sixth only evens out the loop

  [[gnu::always_inline]] PlaneTimes(const RayFrame& ray, const int (&corner)[3], int child_size) {
    for (int a = 0; a < 3; ++a) {
      const double first = corner[a], size = child_size;
      for (int k = 0; k < 6; ++k) s[a][k] = (first + k * size - ray.origin[a]) * ray.inverse[a];
    }
  }
  double in(int x, int y, int z, double start) const {
    return std::max(std::max(s[0][x], s[1][y]), std::max(s[2][z], start));
  }
  double out(int x, int y, int z, double end) const {
    return std::min(std::min(s[0][x + 1], s[1][y + 1]), std::min(s[2][z + 1], end));
  }
};

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

// The ends of the ray's segment in a cell.
[[gnu::always_inline]] inline void set_ends(const RayFrame& ray, const PlaneTimes& times,
                                            const int (&digit)[3], VisitedCell& cell) {
  for (int a = 0; a < 3; ++a) {
    const double low = cell.position[a], high = low + 1;
    // cell.in is the largest of the lower planes' times and 0, cell.out likewise.
    const double in = times.s[a][digit[a]] == cell.in ? low : ray.origin[a] + cell.in * ray.direction[a];
    const double out =
        times.s[a][digit[a] + 1] == cell.out ? high : ray.origin[a] + cell.out * ray.direction[a];
    cell.segment.in.x[a] = std::min(std::max(in - low, 0.0), 1.0);
    cell.segment.in.rest[a] = std::min(std::max(high - in, 0.0), 1.0);
    cell.segment.out.x[a] = std::min(std::max(out - low, 0.0), 1.0);
    cell.segment.out.rest[a] = std::min(std::max(high - out, 0.0), 1.0);
  }
}

} // namespace walk

// Calls visit(cell) for every surface cell that the ray meets, front to back, until it returns true. Returns
// whether it did. Begins where skip_empty_nodes, if it was called, has moved the ray to.
template <class Visit>
bool walk_cells(const SurfaceBlocks& surface, const RayFrame& ray, WalkCounts& counts, Visit&& visit) {
  const walk::NodeTable table(surface, ray.octant);
  int record_stride[3] = {1, SurfaceBlocks::record_stride_y, SurfaceBlocks::record_stride_z};
  int record_origin = 0;
  for (int a = 0; a < 3; ++a)
    if (ray.octant >> a & 1) {
      record_origin += record_stride[a] * block_dim;
      record_stride[a] = -record_stride[a];
    }
  const int mirrored_bits = (ray.octant & 1 ? 3 : 0) | (ray.octant & 2 ? 12 : 0) | (ray.octant & 4 ? 48 : 0);

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
      for (int a = 0; a < 3; ++a) cell.position[a] = corner[a] + digit[a];
      walk::set_ends(ray, times, digit, cell);
      const float* const base = record + record_origin + digit[0] * record_stride[0] +
                                digit[1] * record_stride[1] + digit[2] * record_stride[2];
      for (int c = 0; c < 8; ++c)
        cell.segment.corner[c] = base[(c & 1 ? record_stride[0] : 0) + (c & 2 ? record_stride[1] : 0) +
                                      (c & 4 ? record_stride[2] : 0)];
      cell.segment.error = record[SurfaceBlocks::record_error];
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
