// What a sample of a conversion must be, by slow and independent means, and where two conversions differ.
#pragma once

#include "levelray/core/parallel.hpp"
#include "levelray/grid/block_grid.hpp"
#include "levelray/mesh/prepare.hpp"
#include "levelray/mesh/triangle_bvh.hpp"
#include "levelray/mesh/winding_number.hpp"

#include <bit>
#include <cmath>
#include <vector>

namespace levelray::test {

// Distances and windings of a prepared mesh in double precision.
class MeshTruth {
 public:
  explicit MeshTruth(const PreparedMesh& mesh) : mesh_(mesh), bvh_(mesh.mesh) {}

  const TriangleMesh& mesh() const { return mesh_.mesh; }
  MeshPoint nearest(const Vec3d& p) const { return *bvh_.closest_point(p); }

  // The winding number: of meshes without open edges by what a ray crosses, which is an exact integer; else
  // the sum over all triangles.
  double winding(const Vec3d& p) const {
    if (!mesh_.open_edges.empty()) return winding_number(mesh_.mesh, p);
    WorldRay ray;
    ray.origin = p;
    ray.direction = Vec3d(0.4271, 0.7583, 0.4926); // along no axis, diagonal or other likely plane
    int winding = 0;
    bvh_.all_hits(ray, [&](const TriangleHit& hit) { winding += hit.front ? -1 : 1; });
    return winding;
  }

  // Whether `value`, in world units, is right for the sample at `p` of a grid with that voxel size and
  // background: the magnitude within 10^-5 voxel (conversion's promise) and a float's rounding, the side
  // inside where the winding number exceeds 1/2. On the surface itself, up to the rounding of coordinates
  // (2^-50 of their size), either sign is right.
  bool is_right(float value, const Vec3d& p, double voxel, double background) const {
    const double expected = std::min(std::sqrt(nearest(p).distance_squared), background);
    const double magnitude = std::fabs(static_cast<double>(value));
    if (!(std::fabs(magnitude - expected) <= 1e-5 * voxel + 0x1p-24 * expected)) return false;
    const double coordinates =
        std::max({std::fabs(p.x), std::fabs(p.y), std::fabs(p.z), mesh_.report.bounds.size().length()});
    return expected <= 0x1p-50 * coordinates || std::signbit(value) == (winding(p) > 0.5);
  }

 private:
  const PreparedMesh& mesh_;
  TriangleBvh bvh_;
};

struct Difference {
  Vec3i sample;
  float ours = 0, theirs = 0; // world units
  bool ours_active = false, theirs_active = false;
};

struct Comparison {
  std::uint64_t in_either = 0, in_both = 0; // active samples
  std::vector<Difference> differences;      // above the tolerance, in no particular order
  double largest_alike = 0;                 // voxels: the largest |difference| below the tolerance
};

// Calls visit(sample, value) for the active samples of a grid.
template <class Visit>
void for_each_active(const BlockGrid& grid, Visit&& visit) {
  for (const BlockGrid::Node& node : grid.nodes) {
    std::size_t block = node.first_block;
    for (std::uint64_t stored = node.stored; stored; stored &= stored - 1, ++block) {
      const int b = std::countr_zero(stored);
      const Vec3i first = node.coord * node_dim + Vec3i(bit_x(b), bit_y(b), bit_z(b)) * block_dim;
      for (std::uint64_t active = grid.active[block]; active; active &= active - 1) {
        const int s = std::countr_zero(active);
        visit(first + Vec3i(bit_x(s), bit_y(s), bit_z(s)),
              grid.values[block * samples_per_block + static_cast<std::size_t>(s)]);
      }
    }
  }
}

inline bool is_active(const BlockGrid& grid, const Vec3i& s) {
  const std::uint32_t entry = grid.node_entry(s.x, s.y, s.z);
  if (entry >= BlockGrid::inside_node) return false;
  const BlockGrid::Node& node = grid.nodes[entry];
  const int bit = bit_in_node(s.x, s.y, s.z);
  return node.stored >> bit & 1 &&
         grid.active[BlockGrid::block_index(node, bit)] >> bit_in_block(s.x, s.y, s.z) & 1;
}

// Compares all samples that are active in either of two grids of one transform.
inline Comparison compare_grids(const BlockGrid& ours, const BlockGrid& theirs, double tolerance_voxels) {
  Comparison result;
  const double voxel = ours.transform.voxel_size;
  const auto compare = [&](const Vec3i& s, bool ours_active, bool theirs_active) {
    ++result.in_either;
    result.in_both += ours_active && theirs_active;
    const float a = ours.value(s.x, s.y, s.z), b = theirs.value(s.x, s.y, s.z);
    const double difference = std::fabs(static_cast<double>(a) - static_cast<double>(b)) / voxel;
    if (difference <= tolerance_voxels)
      result.largest_alike = std::max(result.largest_alike, difference);
    else
      result.differences.push_back({s, a, b, ours_active, theirs_active});
  };
  for_each_active(ours, [&](const Vec3i& s, float) { compare(s, true, is_active(theirs, s)); });
  for_each_active(theirs, [&](const Vec3i& s, float) {
    if (!is_active(ours, s)) compare(s, false, true);
  });
  return result;
}

// For each difference, whether our value is right.
inline std::vector<char> ours_right(const MeshTruth& truth, const BlockGrid& ours,
                                    const std::vector<Difference>& differences) {
  std::vector<char> right(differences.size());
  parallel_for(differences.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Difference& d = differences[i];
      right[i] = truth.is_right(d.ours, ours.transform.to_world(Vec3d(d.sample)), ours.transform.voxel_size,
                                static_cast<double>(ours.background));
    }
  });
  return right;
}

} // namespace levelray::test
