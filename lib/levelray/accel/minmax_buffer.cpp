#include "levelray/accel/minmax_buffer.hpp"

#include "levelray/accel/box_masks.hpp"
#include "levelray/core/parallel.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>

namespace levelray {

namespace {

constexpr RayBounds nothing{std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity()};

// Draws boxes into buffers of its own.
class Painter {
 public:
  Painter(const SurfaceBlocks& surface, const GridTransform& transform, const PinholeView& view,
          int resolution)
      : surface_(surface), resolution_(resolution), voxel_(transform.voxel_size),
        eye_((view.eye - transform.origin) * (1 / transform.voxel_size)), axes_{view.right, view.up,
                                                                                view.forward},
        skew_(view.skew), half_{view.half_width, view.half_height},
        cells(static_cast<std::size_t>(resolution) * static_cast<std::size_t>(resolution), nothing) {}

  // Whether the camera is so far away that bounds mean nothing (and squares would overflow), or no number.
  bool beyond_reach() const {
    const double far = std::max({std::fabs(eye_.x), std::fabs(eye_.y), std::fabs(eye_.z)});
    return !(far < 1e100);
  }

  void paint_node(std::size_t at, const Vec3i& coord) {
    const SurfaceBlocks::Node& node = surface_.node(at);
    const Vec3d corner(coord * node_dim);
    Footprint footprint;
    if (!project(corner, ChildExtent(node.blocks), block_dim, footprint)) return;
    std::size_t block = node.first;
    for (std::uint64_t rest = node.blocks; rest; rest &= rest - 1, ++block) {
      const int bit = std::countr_zero(rest);
      const Vec3d low = corner + Vec3d(bit_x(bit), bit_y(bit), bit_z(bit)) * block_dim;
      if (project(low, ChildExtent(surface_.cells(block)), 1, footprint)) paint(footprint);
    }
  }

 private:
  // The buffer cells of a box, ends included, and its distances in voxels.
  struct Footprint {
    int low[2], high[2];
    double near, far;
  };

  // Returns false where the box is not in the image.
  bool project(const Vec3d& corner, const ChildExtent& extent, double child_size,
               Footprint& footprint) const {
    double half[3], centre[3], near = 0, far = 0, reach = 0;
    for (int a = 0; a < 3; ++a) {
      half[a] = 0.5 * (extent.high[a] - extent.low[a]) * child_size;
      centre[a] = corner[a] + extent.low[a] * child_size + half[a] - eye_[a];
      const double distance = std::fabs(centre[a]), gap = std::max(distance - half[a], 0.0);
      near += gap * gap, far += (distance + half[a]) * (distance + half[a]);
      reach += distance;
    }
    // How far a ray that is said to go through an image position may be off the ideal one, at the box, in
    // voxels: its direction is normalised and scaled, its origin is moved to the grid, at half an ulp (2^-53)
    // of the distance or of the eye's coordinates each, in some ten operations; the numbers here have as
    // many.
    const double margin = 0x1p-16 +
                          0x1p-44 * (reach + std::fabs(eye_.x) + std::fabs(eye_.y) + std::fabs(eye_.z)) +
                          4 * skew_ * reach;

    double low[3], high[3];
    for (int i = 0; i < 3; ++i) {
      const Vec3d& axis = axes_[i];
      const double c = axis.x * centre[0] + axis.y * centre[1] + axis.z * centre[2];
      const double e =
          std::fabs(axis.x) * half[0] + std::fabs(axis.y) * half[1] + std::fabs(axis.z) * half[2] + margin;
      low[i] = c - e, high[i] = c + e;
    }
    if (high[2] <= 0) return false; // behind: rays go forward
    const double nearest = std::max(low[2], 0.0);
    for (int i = 0; i < 2; ++i) {
      // Slopes, then buffer cells; divisions by 0 give the infinities that are meant, and 0 / 0 does not
      // occur, as the numerators' signs exclude 0.
      const double first = low[i] / (low[i] < 0 ? nearest : high[2]),
                   last = high[i] / (high[i] < 0 ? high[2] : (high[i] > 0 ? nearest : high[2]));
      const double scale = 0.5 * resolution_ / half_[i], middle = 0.5 * resolution_;
      // The vertical axis points up, rows go down. 2^-20 cell is for the rounding here and of image
      // positions.
      const double from = (i == 0 ? middle + first * scale : middle - last * scale) - 0x1p-20,
                   to = (i == 0 ? middle + last * scale : middle - first * scale) + 0x1p-20;
      if (from >= resolution_ || to < 0) return false;
      footprint.low[i] = from > 0 ? static_cast<int>(from) : 0;
      footprint.high[i] = to < resolution_ ? static_cast<int>(to) : resolution_ - 1;
    }
    footprint.near = std::sqrt(near) - margin;
    footprint.far = std::sqrt(far) + margin;
    return true;
  }

  void paint(const Footprint& footprint) {
    // Twice the rounding to float, outwards; 2^-148 is that of denormals.
    constexpr double largest = std::numeric_limits<float>::max();
    const auto near =
        static_cast<float>(std::min(footprint.near * (1 - 0x1p-23) * voxel_ - 0x1p-148, largest));
    const double far_world = footprint.far * (1 + 0x1p-23) * voxel_ + 0x1p-148;
    const float far =
        far_world <= largest ? static_cast<float>(far_world) : std::numeric_limits<float>::infinity();
    for (int j = footprint.low[1]; j <= footprint.high[1]; ++j) {
      RayBounds* const row = &cells[static_cast<std::size_t>(j) * static_cast<std::size_t>(resolution_)];
      for (int i = footprint.low[0]; i <= footprint.high[0]; ++i) {
        row[i].near = std::min(row[i].near, near);
        row[i].far = std::max(row[i].far, far);
      }
    }
  }

  const SurfaceBlocks& surface_;
  int resolution_;
  double voxel_;
  Vec3d eye_, axes_[3];
  double skew_;
  double half_[2];

 public:
  std::vector<RayBounds> cells;
};

} // namespace

MinMaxBuffer::MinMaxBuffer(const SurfaceBlocks& surface, const GridTransform& transform,
                           const PinholeView& view, int resolution)
    : resolution_(resolution) {
  assert(resolution >= 1 && resolution <= 4096);
  const Painter empty(surface, transform, view, resolution);
  cells_ = empty.cells;
  if (surface.empty()) return;
  if (empty.beyond_reach()) {
    std::fill(cells_.begin(), cells_.end(), RayBounds());
    return;
  }

  // A few parts with buffers of their own. Their number may depend on that of threads, because minima and
  // maxima do not depend on how they are grouped.
  const Vec3i dims = surface.node_dims();
  const auto rows = static_cast<std::size_t>(dims.y) * static_cast<std::size_t>(dims.z);
  const std::size_t parts = std::min(rows, static_cast<std::size_t>(std::min(thread_count(), 16)));
  std::vector<Painter> painters(parts, empty);
  parallel_for(parts, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t part = begin; part < end; ++part)
      for (std::size_t row = part; row < rows; row += parts) { // in turns: surfaces gather in the middle
        const std::size_t first = row * static_cast<std::size_t>(dims.x);
        const Vec3i coord =
            surface.node_min() + Vec3i(0, static_cast<int>(row) % dims.y, static_cast<int>(row) / dims.y);
        for (int x = 0; x < dims.x; ++x)
          if (surface.leap(0, first + static_cast<std::size_t>(x)) == 0)
            painters[part].paint_node(first + static_cast<std::size_t>(x), coord + Vec3i(x, 0, 0));
      }
  });
  parallel_for(cells_.size(), 16384, [&](std::size_t begin, std::size_t end) {
    for (const Painter& painter : painters)
      for (std::size_t i = begin; i < end; ++i) {
        cells_[i].near = std::min(cells_[i].near, painter.cells[i].near);
        cells_[i].far = std::max(cells_[i].far, painter.cells[i].far);
      }
  });
}

} // namespace levelray
