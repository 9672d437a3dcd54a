#include "levelray/measure/compare_grids.hpp"

#include "levelray/core/parallel.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace levelray {

namespace {

constexpr std::uint64_t samples_per_node = node_dim * node_dim * node_dim;

// How far, in voxels, the farthest corner of either grid's extent lies from its place in the other; the
// difference of two transforms is linear, so no sample is farther.
double displacement_voxels(const BlockGrid& a, const BlockGrid& b) {
  double farthest = 0;
  for (const BlockGrid* grid : {&a, &b})
    for (int corner = 0; corner < 8; ++corner) {
      Vec3d index;
      for (int axis = 0; axis < 3; ++axis)
        index[axis] =
            node_dim * (grid->node_min[axis] + (corner >> axis & 1 ? double(grid->node_dims[axis]) : 0.0));
      const double d =
          (a.transform.to_world(index) - b.transform.to_world(index)).length() / a.transform.voxel_size;
      farthest = std::max(farthest, d);
    }
  return farthest;
}

std::string text_of(const GridTransform& t) {
  return fmt::format("voxel {:.9g}, sample 0,0,0 at ({:.9g}, {:.9g}, {:.9g})", t.voxel_size, t.origin.x,
                     t.origin.y, t.origin.z);
}

// A block of a node, stored or not.
struct BlockView {
  const float* values = nullptr; // null: all are +-background
  std::uint64_t active = 0;
  bool inside = false; // when not stored
};

BlockView block_of(const BlockGrid& grid, std::uint32_t entry, int bit) {
  BlockView view;
  if (entry >= BlockGrid::inside_node) {
    view.inside = entry == BlockGrid::inside_node;
    return view;
  }
  const BlockGrid::Node& node = grid.nodes[entry];
  if (node.stored >> bit & 1) {
    const std::size_t block = BlockGrid::block_index(node, bit);
    view.values = &grid.values[block * samples_per_block];
    view.active = grid.active[block];
  } else {
    view.inside = node.inside >> bit & 1;
  }
  return view;
}

class Comparer {
 public:
  Comparer(const BlockGrid& a, const BlockGrid& b, GridComparison& result) : a_(a), b_(b), result_(result) {}

  void node(const Vec3i& coord) {
    const Vec3i first = coord * node_dim;
    const std::uint32_t ea = a_.node_entry(first.x, first.y, first.z),
                        eb = b_.node_entry(first.x, first.y, first.z);
    if (ea >= BlockGrid::inside_node && eb >= BlockGrid::inside_node) {
      if (ea != eb) flipped(first, samples_per_node);
      return;
    }
    for (int bit = 0; bit < 64; ++bit) {
      const Vec3i corner = first + 4 * Vec3i(bit_x(bit), bit_y(bit), bit_z(bit));
      const BlockView va = block_of(a_, ea, bit), vb = block_of(b_, eb, bit);
      if (va.values || vb.values)
        block(corner, va, vb);
      else if (va.inside != vb.inside)
        flipped(corner, samples_per_block);
    }
  }

  void finish() {
    const double n = static_cast<double>(std::max<std::uint64_t>(result_.samples.total(), 1));
    result_.mean = sum_ / n;
    result_.rms = std::sqrt(squares_ / n);
    result_.max_position = a_.transform.to_world(Vec3d(result_.max_at));
  }

 private:
  void record(const Vec3i& at, double d, std::uint64_t times, double& sum, double& squares) {
    result_.samples.add(d, times);
    sum += d * static_cast<double>(times);
    squares += d * d * static_cast<double>(times);
    if (d > result_.max) {
      result_.max = d;
      result_.max_at = at;
    }
  }

  // Inactive in both, of different sides, from sample `at`.
  void flipped(const Vec3i& at, std::uint64_t times) {
    result_.inactive_flips += times;
    record(at, (static_cast<double>(a_.background) + b_.background) / a_.transform.voxel_size, times, sum_,
           squares_);
  }

  void block(const Vec3i& corner, const BlockView& va, const BlockView& vb) {
    double sum = 0, squares = 0; // of the block first, which keeps rounding errors small
    for (int bit = 0; bit < samples_per_block; ++bit) {
      const auto value = [bit](const BlockGrid& grid, const BlockView& view) {
        return static_cast<double>(view.values   ? view.values[bit]
                                   : view.inside ? -grid.background
                                                 : grid.background);
      };
      const double x = value(a_, va), y = value(b_, vb);
      const bool in_a = va.active >> bit & 1, in_b = vb.active >> bit & 1, flip = (x < 0) != (y < 0);
      result_.active_a += in_a;
      result_.active_b += in_b;
      result_.only_in_a += in_a && !in_b;
      result_.only_in_b += in_b && !in_a;
      if (!in_a && !in_b && !flip) continue;
      (in_a || in_b ? result_.sign_flips : result_.inactive_flips) += flip;
      record(corner + Vec3i(bit_x(bit), bit_y(bit), bit_z(bit)), std::fabs(x - y) / a_.transform.voxel_size,
             1, sum, squares);
    }
    sum_ += sum;
    squares_ += squares;
  }

  const BlockGrid& a_;
  const BlockGrid& b_;
  GridComparison& result_;
  double sum_ = 0, squares_ = 0;
};

template <class Visit>
void for_each_node(const BlockGrid& grid, const Visit& visit) {
  for (int z = 0; z < grid.node_dims.z; ++z) {
    check_cancel();
    for (int y = 0; y < grid.node_dims.y; ++y)
      for (int x = 0; x < grid.node_dims.x; ++x) visit(grid.node_min + Vec3i(x, y, z));
  }
}

bool in_table(const BlockGrid& grid, const Vec3i& node) {
  for (int a = 0; a < 3; ++a)
    if (node[a] < grid.node_min[a] || node[a] - grid.node_min[a] >= grid.node_dims[a]) return false;
  return true;
}

} // namespace

GridComparison compare_grids(const BlockGrid& a, const BlockGrid& b, const Thresholds& thresholds) {
  GridComparison result;
  result.samples = ThresholdCount(thresholds);
  const double displaced = displacement_voxels(a, b);
  if (!(displaced <= std::max(thresholds.fail, 1e-6))) {
    result.mismatch =
        fmt::format("different transforms: {}; and {}", text_of(a.transform), text_of(b.transform));
    result.verdict = Verdict::failure;
    return result;
  }
  if (displaced > 0)
    result.remarks.push_back(fmt::format("the samples' places differ by up to {:.3g} voxels", displaced));

  Comparer comparer(a, b, result);
  for_each_node(a, [&](const Vec3i& node) { comparer.node(node); });
  for_each_node(b, [&](const Vec3i& node) { // beyond a's table a is outside
    if (!in_table(a, node)) comparer.node(node);
  });
  comparer.finish();

  result.background_difference =
      std::fabs(static_cast<double>(a.background) - b.background) / a.transform.voxel_size;
  result.verdict = result.samples.verdict();
  if (result.background_difference > 0)
    result.remarks.push_back(
        fmt::format("different backgrounds: {:.9g} and {:.9g}", a.background, b.background));
  if (result.background_difference > std::min(thresholds.fail, thresholds.hard_fail))
    result.verdict = Verdict::failure;
  return result;
}

} // namespace levelray
