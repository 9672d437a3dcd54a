// Steps through the table of nodes: over one node, or over the empty cube that begins with it.
#pragma once

#include "levelray/accel/ray_frame.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace levelray {

namespace walk {

// The table as a mirrored ray sees it.
struct NodeTable {
  const std::uint8_t* leaps;
  int dims[3];
  std::ptrdiff_t stride[3], origin = 0;

  [[gnu::always_inline]] NodeTable(const SurfaceBlocks& surface, int octant)
      : leaps(surface.leaps(octant)), dims{surface.node_dims().x, surface.node_dims().y,
                                           surface.node_dims().z},
        stride{1, dims[0], std::ptrdiff_t{dims[0]} * dims[1]} {
    for (int a = 0; a < 3; ++a)
      if (octant >> a & 1) {
        origin += stride[a] * (dims[a] - 1);
        stride[a] = -stride[a];
      }
  }
  bool has(int x, int y, int z) const { return (x < dims[0]) & (y < dims[1]) & (z < dims[2]); }
  std::size_t entry(const int (&at)[3]) const {
    return static_cast<std::size_t>(origin + at[0] * stride[0] + at[1] * stride[1] + at[2] * stride[2]);
  }
};

// Where a ray that is at `start` leaves the cube of `length` nodes that begins with node `at`.
struct NodeExit {
  double s;
  int crossed[3]; // 1 for the axis of the plane there, else 0

  [[gnu::always_inline]] NodeExit(const RayFrame& ray, const int (&at)[3], int length, double start) {
    double leave[3];
    for (int a = 0; a < 3; ++a) leave[a] = ((at[a] + length) * node_dim - ray.origin[a]) * ray.inverse[a];
    const bool by_x = (leave[0] <= leave[1]) & (leave[0] <= leave[2]);
    const bool by_y = !by_x & (leave[1] <= leave[2]);
    s = std::max(start, std::min(leave[0], std::min(leave[1], leave[2])));
    crossed[0] = by_x, crossed[1] = by_y, crossed[2] = !by_x & !by_y;
  }

  // Moves on to the next node: the crossed axis by integers, the others to where the ray is. Returns whether
  // there is one. Beyond the ray's end nothing counts; a plane crossed at the very end is no reason to go on
  // either, because the cells before it have been visited up to it.
  [[gnu::always_inline]] bool move(const RayFrame& ray, const NodeTable& table, int length,
                                   int (&at)[3]) const {
    if (!(s < ray.last)) return false;
    int next[3];
    if (length > 1) {
      bool near_plane = false;
      for (int a = 0; a < 3; ++a) {
        const double p = (ray.origin[a] + s * ray.direction[a]) * (1.0 / node_dim);
        const int node = static_cast<int>(p);
        near_plane |= !(std::fabs(p - node - 0.5) < 0.5 - 0x1p-20) & (crossed[a] == 0);
        // Rounding may put the point on the far side of the cube, or of the table.
        const int inside = std::min(std::max(node, at[a]), std::min(at[a] + length, table.dims[a]) - 1);
        next[a] = crossed[a] ? at[a] + length : inside;
      }
      if (near_plane) [[unlikely]]
        return settle(ray, table, length, next, at);
    } else {
      for (int a = 0; a < 3; ++a) next[a] = at[a] + crossed[a];
    }
    for (int a = 0; a < 3; ++a) at[a] = next[a];
    return table.has(next[0], next[1], next[2]);
  }

 private:
  // Where the point lies so close to a node's plane that rounding may have put it on the wrong side, the
  // times of the planes decide, as they do for steps over single nodes: planes that are crossed at the same
  // time are crossed in the order of their axes. So leaps lead to nodes on the path of single steps, whatever
  // cubes they go through, and all walks see the same nodes with surface blocks.
  [[gnu::cold]] bool settle(const RayFrame& ray, const NodeTable& table, int length, const int (&next)[3],
                            int (&at)[3]) const;
};

} // namespace walk

// Says that the ray meets surface cells in [near, far] only, in units of its own t, if it meets any: moves
// the walk's beginning and end there, with a margin for the rounding of the frame. near > far: it meets none;
// NaN says nothing. Returns false where nothing is left of the ray.
//
// The walk sees the same surface cells in the same order, with the same segments: those depend on the frame's
// origin and end, which stay. What it leaves out are nodes, and blocks of a node, that the ray has left
// before `near` or enters after `far`.
bool narrow_frame(const SurfaceBlocks& surface, RayFrame& ray, double near, double far);
// The same for the bounding box of the surface blocks, within a voxel.
bool narrow_frame_to_blocks(const SurfaceBlocks& surface, RayFrame& ray);

// Moves the beginnings of rays over the empty nodes before their first node with surface blocks. Clears
// `entered` of those that meet none; walk_cells would find nothing on them. At most 256 rays.
void skip_empty_nodes(const SurfaceBlocks& surface, std::span<RayFrame> rays, std::span<bool> entered);

} // namespace levelray
