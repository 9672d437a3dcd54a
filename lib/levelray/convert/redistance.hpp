// A level set whose values are no distances becomes one whose values are.
#pragma once

#include "levelray/convert/field_facts.hpp"
#include "levelray/grid/block_grid.hpp"

#include <cstdint>
#include <functional>

namespace levelray {

struct RedistanceOptions {
  double half_width_voxels = 3;              // >= 1: of the band that is made
  std::uint64_t max_memory = 0;              // bytes; 0: no limit
  std::function<void(double done)> progress; // called from any thread, done in [0,1]; may be empty
};

struct RedistanceReport {
  std::uint64_t surface_cells = 0; // cells with samples of both sides
  // How far the surface moved where the old one crosses the lattice's edges: the new field's value there,
  // which is a distance up to the error of interpolating it, in voxels.
  std::uint64_t crossings = 0;
  double rms_moved_voxels = 0, largest_moved_voxels = 0;
  FieldFacts before, after;
  double ms = 0;
};

// The grid, on the same lattice, whose every sample within the half-width of the surface holds its distance
// to it. The surface is the zero set of the source's trilinear interpolant, between the cells' corners where
// the field changes its sign; it is found to within 1/128 voxel, or 3/128 times its curvature in voxels where
// that is more (zero_set.hpp), and distances to what was found are exact to rounding. Signs are the source's,
// sample by sample: the topology of its samples stays, and the new surface crosses the same edges of the
// lattice. It is not quite the old one: interpolation between exact distances errs by up to an eighth of the
// surface's curvature, in voxels, which the report measures. (Keeping the samples next to the surface would
// keep it, but not make them distances; normals from differences of such samples are as uneven as the
// source's.) Where the field touches zero without changing its sign there is no surface.
//
// The source needs its cell masks (complete_blocks). The result does not depend on the number of threads.
// Throws Error(limit) where it would exceed max_memory, Error(bad_input) where no two samples differ in sign.
BlockGrid redistance(const BlockGrid& source, const RedistanceOptions& options,
                     RedistanceReport* report = nullptr);

} // namespace levelray
