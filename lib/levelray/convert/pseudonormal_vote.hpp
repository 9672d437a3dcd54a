// The side of a region by the pseudonormal of what is nearest to it.
#pragma once

#include "levelray/convert/voxel_mesh.hpp"
#include "levelray/mesh/pseudonormal.hpp"

#include <cstdint>
#include <span>

namespace levelray {

// The vote of a component of a block: its number of samples in the band, positive for inside, negative for
// outside, 0 without any.
//
// All samples of a component lie on one side (link_components.hpp), so one of them speaks for it: the one
// farthest from the surface but still in the band, where rounding matters least. Its nearest point is found
// in double among the block's candidates, and the pseudonormal of that point's feature tells the side
// (Baerentzen & Aanaes 2005). Regions then go by the majority of their components, which outvotes folds and
// self-intersections.
std::int32_t pseudonormal_vote(const VoxelMesh& mesh, const Pseudonormals& pseudonormals,
                               std::span<const std::uint32_t> candidates, const Vec3i& first_sample,
                               const float* distance, std::uint64_t samples, float half_width);

} // namespace levelray
