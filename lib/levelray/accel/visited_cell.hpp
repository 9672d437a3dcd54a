// What walks show of the surface cells they find, and how they fill it in.
#pragma once

#include "levelray/accel/ray_frame.hpp"
#include "levelray/grid/cell_segment.hpp"

#include <algorithm>

namespace levelray {

struct WalkCounts {
  std::uint32_t nodes = 0, blocks = 0;
  std::uint32_t cells = 0;       // surface cells, which were shown
  std::uint32_t other_cells = 0; // stepped over; only walks that go cell by cell have them
  std::uint32_t steps() const { return nodes + blocks + cells + other_cells; }
};

struct VisitedCell {
  CellSegment segment;
  double in, out;  // s
  int position[3]; // in cells of the frame
};

namespace walk {

// s of the plane with that coordinate.
[[gnu::always_inline]] inline double plane_time(const RayFrame& ray, int axis, double coordinate) {
  return (coordinate - ray.origin[axis]) * ray.inverse[axis];
}

// s of the five planes that bound and divide a 4x4x4 box, per axis.
struct PlaneTimes {
  double s[3][6]; // the sixth only evens out the loop

  [[gnu::always_inline]] PlaneTimes(const RayFrame& ray, const int (&corner)[3], int child_size) {
    for (int a = 0; a < 3; ++a) {
      const double first = corner[a], size = child_size;
      for (int k = 0; k < 6; ++k) s[a][k] = plane_time(ray, a, first + k * size);
    }
  }
  double in(int x, int y, int z, double start) const {
    return std::max(std::max(s[0][x], s[1][y]), std::max(s[2][z], start));
  }
  double out(int x, int y, int z, double end) const {
    return std::min(std::min(s[0][x + 1], s[1][y + 1]), std::min(s[2][z + 1], end));
  }
};

// The ends of the ray's segment in a cell.
[[gnu::always_inline]] inline void set_ends(const RayFrame& ray, const PlaneTimes& times,
                                            const int (&digit)[3], VisitedCell& cell) {
  for (int a = 0; a < 3; ++a) {
    const double low = cell.position[a], high = low + 1;
    // cell.in is the largest of the lower planes' times and 0, cell.out likewise.
    const double in = times.s[a][digit[a]] == cell.in ? low : ray.origin[a] + cell.in * ray.direction[a];
    const double out =
        times.s[a][digit[a] + 1] == cell.out ? high : ray.origin[a] + cell.out * ray.direction[a];
    cell.segment.in.x[a] = std::min(std::max(in - low, 0.0), 1.0);
    cell.segment.in.rest[a] = std::min(std::max(high - in, 0.0), 1.0);
    cell.segment.out.x[a] = std::min(std::max(out - low, 0.0), 1.0);
    cell.segment.out.rest[a] = std::min(std::max(high - out, 0.0), 1.0);
  }
}

// Reads cells out of the records of blocks as a mirrored ray sees them.
struct CellReader {
  int stride[3] = {1, SurfaceBlocks::record_stride_y, SurfaceBlocks::record_stride_z}, origin = 0;

  [[gnu::always_inline]] explicit CellReader(int octant) {
    for (int a = 0; a < 3; ++a)
      if (octant >> a & 1) {
        origin += stride[a] * block_dim;
        stride[a] = -stride[a];
      }
  }
  // Fills in the cell at `digit` of the block at `corner`; its `in` and `out` are known.
  [[gnu::always_inline]] void read(const RayFrame& ray, const PlaneTimes& times, const int (&corner)[3],
                                   const int (&digit)[3], const float* record, VisitedCell& cell) const {
    for (int a = 0; a < 3; ++a) cell.position[a] = corner[a] + digit[a];
    set_ends(ray, times, digit, cell);
    const float* const base =
        record + origin + digit[0] * stride[0] + digit[1] * stride[1] + digit[2] * stride[2];
    for (int c = 0; c < 8; ++c)
      cell.segment.corner[c] =
          base[(c & 1 ? stride[0] : 0) + (c & 2 ? stride[1] : 0) + (c & 4 ? stride[2] : 0)];
    cell.segment.error = record[SurfaceBlocks::record_error];
  }
};

// The bits by which those of a mirrored ray's children differ from the stored ones.
constexpr int mirrored_bits(int octant) {
  return (octant & 1 ? 3 : 0) | (octant & 2 ? 12 : 0) | (octant & 4 ? 48 : 0);
}

} // namespace walk

} // namespace levelray
