// Which triangles may matter to which nodes of the grid.
#pragma once

#include "levelray/convert/voxel_mesh.hpp"

#include <span>
#include <vector>

namespace levelray {

// The node table of the grid to be: node coordinates node_min .. node_min + dims - 1, x fastest.
struct NodeBox {
  Vec3i node_min{0, 0, 0};
  Vec3i dims{0, 0, 0};

  std::size_t count() const { return static_cast<std::size_t>(dims.x) * dims.y * dims.z; }
  std::size_t index(const Vec3i& node) const {
    const Vec3i d = node - node_min;
    return static_cast<std::size_t>(d.x) +
           static_cast<std::size_t>(dims.x) * (d.y + static_cast<std::size_t>(dims.y) * d.z);
  }
  Vec3i coord(std::size_t index) const {
    const std::size_t x = static_cast<std::size_t>(dims.x), y = static_cast<std::size_t>(dims.y);
    return node_min + Vec3i(static_cast<int>(index % x), static_cast<int>(index / x % y),
                            static_cast<int>(index / (x * y)));
  }
  bool contains(const Vec3i& node) const {
    const Vec3i d = node - node_min;
    return d.x >= 0 && d.y >= 0 && d.z >= 0 && d.x < dims.x && d.y < dims.y && d.z < dims.z;
  }
};

// Triangle lists per touched node, in table order; the triangles of a node in ascending order (so caps come
// last).
struct NodeBins {
  std::vector<std::uint32_t> node;  // table indices of the touched nodes
  std::vector<std::uint64_t> first; // node.size() + 1 offsets into `triangles`
  std::vector<std::uint32_t> triangles;

  std::span<const std::uint32_t> list(std::size_t i) const {
    return {triangles.data() + first[i], static_cast<std::size_t>(first[i + 1] - first[i])};
  }
};

// Every triangle closer than `surface_reach` (caps: `cap_reach`) voxels to a sample of a node is in the
// node's list; a few others may be.
NodeBins bin_triangles(const VoxelMesh& mesh, const NodeBox& box, double surface_reach, double cap_reach);

} // namespace levelray
