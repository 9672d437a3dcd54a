// The same cells in the same order as walk_cells, found by stepping: the paper's traversal, to compare with.
//
// Source: Jamriska 2010, section 4.1: a loop over the 4^3 blocks of the coarse grid, one by one, and in
// surface blocks a loop over their cells, one by one, of which those with their bit set are shown; both by
// 3D-DDA (Amanatides and Woo 1987). Ours differs in computing every plane's time from its integer, and in
// ties. A ray that crosses two planes at the same s goes through an edge; closed intervals (cell_walk.hpp)
// hold the two children beside it too, for a length of zero. walk_cells shows all such children of a node, in
// the order of their bits, and takes the nodes themselves in the order of their axes, and so do we here: even
// a hit on an edge belongs to the same cell whichever way the ray is walked.
//
// Counts: `blocks` are the coarse steps, empty blocks included, `cells` and `other_cells` the fine ones.
#pragma once

#include "levelray/accel/node_walk.hpp"
#include "levelray/accel/visited_cell.hpp"
#include "levelray/core/bits.hpp"

#include <limits>

namespace levelray {

namespace walk {

// Calls visit(digit) for the 4x4x4 children that the ray meets in [in, out], in which it is in their box,
// until it returns true. Returns whether it did.
template <class Visit>
[[gnu::always_inline]] inline bool step_children(const PlaneTimes& times, double in, double out,
                                                 Visit&& visit) {
  constexpr double never = std::numeric_limits<double>::infinity();
  int at[3], low[3];
  for (int a = 0; a < 3; ++a) {
    at[a] = low[a] = 0;
    for (int k = 1; k < 4; ++k) at[a] += times.s[a][k] <= in, low[a] += times.s[a][k] < in;
  }
  // Those that the ray is leaving at `in` come before the one that it is entering.
  for (int z = low[2]; z <= at[2]; ++z)
    for (int y = low[1]; y <= at[1]; ++y)
      for (int x = low[0]; x <= at[0]; ++x)
        if (const int digit[3] = {x, y, z}; visit(digit)) return true;
  double leave[3];
  for (int a = 0; a < 3; ++a) leave[a] = at[a] < 3 ? times.s[a][at[a] + 1] : never;
  for (;;) {
    const double s = std::min(leave[0], std::min(leave[1], leave[2]));
    if (!(s <= out)) return false;
    const int tied = (leave[0] == s) | (leave[1] == s) << 1 | (leave[2] == s) << 2;
    if (tied & (tied - 1)) [[unlikely]]
      for (int side = 1; side < tied; ++side) {
        if (side & ~tied) continue;
        const int digit[3] = {at[0] + (side & 1), at[1] + (side >> 1 & 1), at[2] + (side >> 2)};
        if (visit(digit)) return true;
      }
    for (int a = 0; a < 3; ++a)
      if (tied >> a & 1) {
        ++at[a];
        leave[a] = at[a] < 3 ? times.s[a][at[a] + 1] : never;
      }
    if (visit(at)) return true;
  }
}

// The coarse grid as a mirrored ray sees it, and a ray's way through it, block by block.
class BlockSteps {
 public:
  BlockSteps(const SurfaceBlocks& surface, const RayFrame& ray)
      : surface_(&surface), ray_(&ray), table_(surface, ray.octant),
        mirrored_bits_(walk::mirrored_bits(ray.octant)), s_(ray.start) {
    for (int a = 0; a < 3; ++a) {
      const int first = 4 * ray.start_node[a];
      const double p = (ray.origin[a] + s_ * ray.direction[a]) * (1.0 / block_dim);
      at_[a] = std::min(std::max(static_cast<int>(p), first), first + 3);
      while (at_[a] > first && !(time(a, at_[a]) <= s_)) --at_[a];
      while (at_[a] < first + 3 && time(a, at_[a] + 1) <= s_) ++at_[a];
      leave_[a] = time(a, at_[a] + 1);
    }
    enter_node(at_);
  }

  // Calls visit(block's index in the surface, its corner) for the surface blocks on the ray's way, until it
  // returns true. Returns whether it did. Adds a count per block, empty or not. Begins at the block where the
  // ray is now, which is not its first one if it has `begun` to move.
  template <class Visit>
  bool walk(std::uint32_t& count, bool begun, Visit&& visit) {
    const auto visit_at = [&](const int(&at)[3]) {
      ++count;
      const int bit = bit_of(at);
      if (!(blocks_ >> bit & 1)) return false;
      const int corner[3] = {at[0] * block_dim, at[1] * block_dim, at[2] * block_dim};
      return visit(first_ + count_bits(blocks_ & ((std::uint64_t{1} << bit) - 1)), corner);
    };
    if ((!begun && visit_left_behind(visit_at)) || visit_at(at_)) return true;
    for (int tied; next_planes(tied);) {
      if (tied & (tied - 1)) [[unlikely]] {
        if (visit_beside(tied, visit_at)) return true;
      }
      if (!cross(tied)) return false;
      if (visit_at(at_)) return true;
    }
    return false;
  }

  // The planes (bits) that the ray crosses next; false where it ends before.
  bool next_planes(int& tied) {
    const double next = std::min(leave_[0], std::min(leave_[1], leave_[2]));
    if (!(next <= ray_->last)) return false;
    s_ = std::max(s_, next);
    tied = (leave_[0] == next) | (leave_[1] == next) << 1 | (leave_[2] == next) << 2;
    return true;
  }
  // Crosses them; false where there is nothing behind.
  bool cross(int tied) {
    int node_planes = 0;
    for (int a = 0; a < 3; ++a)
      if (tied >> a & 1) {
        leave_[a] = time(a, ++at_[a] + 1);
        node_planes |= (at_[a] & 3) == 0;
      }
    return !node_planes || enter_node(at_);
  }
  bool on_surface() const { return blocks_ >> bit_of(at_) & 1; }
  // The table's entry and the bit of the block where the ray is.
  std::size_t entry() const { return entry_; }
  int bit() const { return bit_of(at_); }

 private:
  int bit_of(const int (&at)[3]) const {
    return ((at[0] & 3) | (at[1] & 3) << 2 | (at[2] & 3) << 4) ^ mirrored_bits_;
  }
  double time(int axis, int block_plane) const {
    return plane_time(*ray_, axis, block_plane * double{block_dim});
  }

  // Looks up the node of a block; false beyond the table and at the ray's end (NodeExit::move).
  bool enter_node(const int (&at)[3]) {
    const int node[3] = {at[0] >> 2, at[1] >> 2, at[2] >> 2};
    if (!(node[0] < table_.dims[0] && node[1] < table_.dims[1] && node[2] < table_.dims[2])) return false;
    entry_ = table_.entry(node);
    blocks_ = 0;
    if (!table_.leaps[entry_]) {
      blocks_ = surface_->node(entry_).blocks;
      first_ = surface_->node(entry_).first;
    }
    return s_ < ray_->last;
  }

  // Blocks of the first node that the ray leaves where it begins.
  template <class VisitAt>
  bool visit_left_behind(VisitAt&& visit_at) {
    int low[3];
    bool any = false;
    for (int a = 0; a < 3; ++a) {
      const bool behind = (at_[a] & 3) != 0 && time(a, at_[a]) == s_;
      low[a] = at_[a] - behind;
      any |= behind;
    }
    if (!any) return false;
    for (int z = low[2]; z <= at_[2]; ++z)
      for (int y = low[1]; y <= at_[1]; ++y)
        for (int x = low[0]; x <= at_[0]; ++x) {
          const int at[3] = {x, y, z};
          if ((x < at_[0] || y < at_[1] || z < at_[2]) && visit_at(at)) return true;
        }
    return false;
  }

  // The blocks beside an edge or a corner through which the ray goes, all but the one that it goes to: node
  // by node in the order of the axes whose planes bound nodes, in a node in the order of bits.
  template <class VisitAt>
  bool visit_beside(int tied, VisitAt&& visit_at) {
    int at_node_planes = 0;
    for (int a = 0; a < 3; ++a) at_node_planes |= ((tied >> a & 1) & ((at_[a] & 3) == 3)) << a;
    const int within = tied & ~at_node_planes;
    int entered = 0;
    for (int axis = 0;;) {
      for (int side = 0; side <= within; ++side) {
        const int moved = entered | side;
        if (side & ~within || moved == 0 || moved == tied) continue;
        const int at[3] = {at_[0] + (moved & 1), at_[1] + (moved >> 1 & 1), at_[2] + (moved >> 2)};
        if (visit_at(at)) return true;
      }
      while (axis < 3 && !(at_node_planes >> axis & 1)) ++axis;
      if (axis == 3) return false;
      entered |= 1 << axis++;
      const int at[3] = {at_[0] + (entered & 1), at_[1] + (entered >> 1 & 1), at_[2] + (entered >> 2)};
      if (!enter_node(at)) return false; // the caller, which goes on to nodes behind that one, stops as well
    }
  }

  const SurfaceBlocks* surface_;
  const RayFrame* ray_;
  NodeTable table_;
  int mirrored_bits_;
  double s_;
  int at_[3];                            // in blocks of the frame
  double leave_[3];                      // times of the upper planes of the block there
  std::size_t entry_ = 0;                // of the node there, and its
  std::uint64_t blocks_ = 0, first_ = 0; // surface blocks
};

} // namespace walk

// As walk_cells, from where `steps` is, which has `begun` to move or not.
template <class Visit>
bool walk_cells_plainly_from(walk::BlockSteps& steps, bool begun, const SurfaceBlocks& surface,
                             const RayFrame& ray, WalkCounts& counts, Visit&& visit) {
  const walk::CellReader reader(ray.octant);
  const int mirrored_bits = walk::mirrored_bits(ray.octant);
  VisitedCell cell;
  return steps.walk(counts.blocks, begun, [&](std::size_t block, const int(&corner)[3]) {
    const walk::PlaneTimes times(ray, corner, 1);
    const double in = times.in(0, 0, 0, 0);
    const double out = std::min(std::min(times.s[0][4], times.s[1][4]), std::min(times.s[2][4], ray.end));
    if (!(in <= out)) return false;
    const std::uint64_t mask = surface.cells(block);
    const float* const record = surface.record(block);
    return walk::step_children(times, in, out, [&](const int(&digit)[3]) {
      const int bit = (digit[0] | digit[1] << 2 | digit[2] << 4) ^ mirrored_bits;
      if (!(mask >> bit & 1)) {
        ++counts.other_cells;
        return false;
      }
      ++counts.cells;
      cell.in = times.in(digit[0], digit[1], digit[2], 0);
      cell.out = times.out(digit[0], digit[1], digit[2], ray.end);
      reader.read(ray, times, corner, digit, record, cell);
      return bool(visit(static_cast<const VisitedCell&>(cell)));
    });
  });
}

// As walk_cells.
template <class Visit>
bool walk_cells_plainly(const SurfaceBlocks& surface, const RayFrame& ray, WalkCounts& counts,
                        Visit&& visit) {
  walk::BlockSteps steps(surface, ray);
  return walk_cells_plainly_from(steps, false, surface, ray, counts, visit);
}

} // namespace levelray
