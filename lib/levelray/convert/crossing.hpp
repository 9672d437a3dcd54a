// Exact signed crossings of lattice edges with triangles.
#pragma once

#include "levelray/convert/voxel_mesh.hpp"

#include <cstddef>
#include <cstdint>

namespace levelray {

// What a segment between neighbouring samples meets.
struct Crossings {
  int triangles = 0; // how many triangles it crosses
  int winding = 0;   // the winding number at its end minus that at its start
};

// The crossings of the segment from sample `p` to the next sample along `axis` (0, 1, 2) with the triangles
// list[0..count) of `mesh`.
//
// Integer arithmetic throughout, with all samples moved by the same infinitesimal vector (e1, e2, e3), e1 >>
// e2 >> e3 > 0 (Edelsbrunner & Muecke 1990, "simulation of simplicity", here of the query points alone): no
// sample lies on a triangle, no segment meets an edge, and neighbouring triangles agree about their common
// edge. So on a closed surface the sums along any two paths between two samples are equal, whatever the
// surface's shape, folds and degeneracies.
Crossings cross_lattice_edge(const VoxelMesh& mesh, const std::uint32_t* list, std::size_t count,
                             const Vec3i& p, int axis);

} // namespace levelray
