// Analytic fields sampled into narrow bands.
#pragma once

#include "levelray/core/parallel.hpp"
#include "levelray/grid/block_grid.hpp"

#include <cmath>
#include <cstdint>
#include <limits>

namespace levelray {

struct FieldSampling {
  double voxel_size = 0.01;     // world units, > 0
  double half_width_voxels = 3; // of the band, >= 1
  Vec3d origin{0, 0, 0};        // of sample (0,0,0)
  std::uint64_t max_bytes = std::numeric_limits<std::uint64_t>::max();
};

// What is known of the nodes over a box before it becomes a grid; see field_to_grid.
class FieldBand {
 public:
  // Covers the box, in world units, and the band around it. Throws Error(limit) where the node table alone
  // would exceed max_bytes, or has indices beyond an int.
  FieldBand(const FieldSampling& sampling, const Box3d& box);

  const BlockGrid& layout() const { return grid_; }
  std::size_t node_count() const { return nodes_.size(); }
  Vec3i node_coord(std::size_t entry) const;
  // To be called once for each node, by any thread: a node all on one side, or the values of its 16^3
  // samples, x fastest, in world units.
  void set_uniform(std::size_t entry, bool inside) { nodes_[entry].inside = inside; }
  void set_samples(std::size_t entry, const float* values);
  // Ends the work. Throws Error(limit) where the grid exceeds max_bytes.
  BlockGrid finish();

 private:
  struct Node {
    bool inside = false; // where there are no values
    std::uint64_t stored = 0, inside_blocks = 0;
    std::vector<float> values; // of the stored blocks
    std::vector<std::uint64_t> active;
  };
  BlockGrid grid_;
  std::vector<Node> nodes_;
  std::uint64_t max_bytes_;
};

// Samples a field, any type with double value(Vec3d) that is negative inside and 1-Lipschitz
// (field/field.hpp), and whose inside lies in `box`. Values are rounded to float and clamped to +-background,
// the half-width rounded up; a sample is active iff |value| < background. All blocks are stored that tracing
// relies on, and the cell masks are set. The same bytes for any number of threads.
//
// Nodes whose centre's value exceeds the band by more than the distance to their corners are not sampled: the
// field cannot come into the band there.
template <class Field>
BlockGrid field_to_grid(const Field& field, const FieldSampling& sampling, const Box3d& box) {
  FieldBand band(sampling, box);
  const GridTransform& transform = band.layout().transform;
  const double background = static_cast<double>(band.layout().background);
  const double half = (node_dim - 1) / 2.0;
  const double reach = (std::sqrt(3.0) * half * transform.voxel_size + background) * (1 + 0x1p-40);
  parallel_for(band.node_count(), 8, [&](std::size_t begin, std::size_t end) {
    std::vector<float> values(node_dim * node_dim * node_dim);
    for (std::size_t entry = begin; entry < end; ++entry) {
      const Vec3i first = band.node_coord(entry) * node_dim;
      const double middle = field.value(transform.to_world(Vec3d(first) + Vec3d(half, half, half)));
      if (std::fabs(middle) > reach) {
        band.set_uniform(entry, middle < 0);
        continue;
      }
      float* next = values.data();
      for (int k = 0; k < node_dim; ++k)
        for (int j = 0; j < node_dim; ++j)
          for (int i = 0; i < node_dim; ++i)
            *next++ = static_cast<float>(field.value(transform.to_world(Vec3d(first + Vec3i(i, j, k)))));
      band.set_samples(entry, values.data());
    }
  });
  return band.finish();
}

} // namespace levelray
