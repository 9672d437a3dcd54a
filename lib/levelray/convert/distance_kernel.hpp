// Squared distances from 4x4x4 points to triangles, vectorised for whatever the processor has.
#pragma once

#include "levelray/convert/triangle_frame.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace levelray {

// Lowers squared[64] (order: x fastest) to the squared distances from the points origin + spacing * (x, y, z)
// with x, y, z in 0..3 to the triangles frames[list[0..count)]; positions are relative to the frames' node
// centre, in voxels. The same bits on every instruction set: multiplications and additions only, in one
// order, never fused.
void lower_squared_distances(const TriangleFrame* frames, const std::uint32_t* list, std::size_t count,
                             const float origin[3], float spacing, float squared[64]);

// For each of frames[0..count): squared distances from those points to that triangle alone, 64 floats apiece.
void squared_distances_each(const TriangleFrame* frames, std::size_t count, const float origin[3],
                            float spacing, float* squared);

// Bit i of the result: values[i] < limit, for 64 values.
std::uint64_t mask_below(const float values[64], float limit);
// Bit i: values[i] <= limits[i].
std::uint64_t mask_at_most(const float values[64], const float limits[64]);
// Lowers each of 64 values to the other's.
void lower_to(float values[64], const float other[64]);

// Bit i of along[axis]: distance[i] + distance[i + 4^axis] > threshold. Reads distance[0..80); bits of
// samples without a next one in their row mean nothing.
void pair_sums_above(const float distance[80], float threshold, std::uint64_t along[3]);

// Replaces 64 values by their square roots.
void square_roots(float values[64]);

// The name of the instruction set in use, for reports.
const char* distance_kernel_target();
// The names of all that this build has code for and this processor can run, the best one first.
std::vector<std::string> distance_kernel_targets();
// Chooses one of them, to compare; "" goes back to the best. Not while others compute.
void use_distance_kernel_target(const std::string& name);

} // namespace levelray
