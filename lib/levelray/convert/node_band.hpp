// The band within one node: unsigned distances of its blocks, and what is known about their sides before any
// sign is decided.
#pragma once

#include "levelray/convert/link_components.hpp"
#include "levelray/convert/voxel_mesh.hpp"
#include "levelray/core/uninitialized_vector.hpp"
#include "levelray/mesh/pseudonormal.hpp"

#include <array>
#include <bit>
#include <span>
#include <utility>
#include <vector>

namespace levelray {

struct BandOptions {
  double half_width_voxels = 3;
  SheetCounting counting = SheetCounting::windings;
  bool find_components = true;                  // false: distances only
  const Pseudonormals* pseudonormals = nullptr; // when given, components vote by them
};

struct NodeBand {
  Vec3i coord{0, 0, 0};   // in nodes
  std::uint64_t kept = 0; // blocks with distances below: those that the band or a cap comes near
  uninitialized_vector<float>
      distance; // 64 per kept block: exact up to the half-width, in voxels; larger values mean "beyond"
  uninitialized_vector<float> sheet_distance; // the same to surface and caps, where caps are near; else empty
  std::vector<BlockComponent>
      components;                  // of all 64 blocks, in order; a block that is not kept is one component
  std::vector<std::int32_t> votes; // per component, when asked: see pseudonormal_vote.hpp
  std::array<std::uint16_t, 65> first{}; // block -> its first component
  std::vector<std::pair<std::uint16_t, FaceCrossing>>
      faces;                         // by 3 * block + axis, ascending; absent: nothing to say
  std::uint32_t node_components = 0; // after joining within the node
  bool near_cap = false;
  int thin_places = 0; // see find_block_components

  std::size_t kept_index(int block) const {
    return static_cast<std::size_t>(std::popcount(kept & ((std::uint64_t{1} << block) - 1)));
  }
  const float* block_distance(int block) const {
    return kept >> block & 1 ? &distance[kept_index(block) * samples_per_block] : nullptr;
  }
  FaceCrossing face(int block, int axis) const {
    const int key = 3 * block + axis;
    for (const auto& [at, crossing] : faces)
      if (at == key) return crossing;
    return {};
  }
  BlockSide side(int block) const {
    const auto& values = sheet_distance.empty() ? distance : sheet_distance;
    return {kept >> block & 1 ? &values[kept_index(block) * samples_per_block] : nullptr,
            {components.data() + first[static_cast<std::size_t>(block)],
             static_cast<std::size_t>(first[static_cast<std::size_t>(block) + 1] -
                                      first[static_cast<std::size_t>(block)])}};
  }
};

// `triangles`: every triangle within the half-width (caps: within 1.01 voxels) of a sample of the node,
// ascending.
NodeBand make_node_band(const VoxelMesh& mesh, const Vec3i& coord, std::span<const std::uint32_t> triangles,
                        const BandOptions& options);

// How far from a sample a cap, or a surface triangle when the band is thinner, matters to signs.
inline constexpr double sign_reach = 1.01;

} // namespace levelray
