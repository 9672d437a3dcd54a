// What methods cost against each other: one table, measured once, so that choices by cost are the same
// everywhere and every time.
//
// Measured by `bench_costs` (tests/bench/costs), which prints the rows below: processor time of one thread,
// medians of interleaved repetitions, over the smooth and sharp shapes of field/reference_shapes.hpp at 128
// voxels with 2^16 random chords each; intersectors per ray, normals per hit, both over `exact`'s time per
// ray, geometric means over the shapes. A row that is missing or left over fails a unit test. What a ray
// costs in one grid against another, and what converting costs, it measures at 32 to 256 voxels.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace levelray {

// 1 is the time of a ray by `exact`. Of the names in intersect/intersectors.hpp and normal/normals.hpp;
// throws Error(usage) for others.
double intersector_cost(std::string_view name);
double normals_cost(std::string_view name);

// Of a ray by `exact` with so many steps and tests (RayCounts), in the same unit.
double ray_cost(double steps, double tests);
// Of making a level set with so many active samples from a mesh.
double conversion_cost(double active_samples);

// The names in the order of their costs, cheapest first.
std::vector<std::string> intersectors_by_cost();
std::vector<std::string> normals_by_cost();

} // namespace levelray
