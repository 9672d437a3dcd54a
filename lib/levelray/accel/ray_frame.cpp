#include "levelray/accel/ray_frame.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace levelray {

namespace {

// Directions of other lengths (in voxels, by their largest component) count as none: shorter ones would make
// t overflow, longer ones make it denormal.
constexpr double shortest = 0x1p-960, longest = 0x1p1000;

// 2^-exponent(x) for x in that range: exact, and x times it lies in [1,2).
double reciprocal_power(double x) {
  return std::bit_cast<double>((2046 - (std::bit_cast<std::uint64_t>(x) >> 52))
                               << 52); // the sign bit is clear
}

} // namespace

bool enter_box(const SurfaceBlocks& surface, const GridTransform& transform, const WorldRay& ray,
               RayFrame& frame) {
  frame.start = 0;
  frame.skipped = 0;
  if (surface.empty() || !(ray.t_min <= ray.t_max)) return false;
  const double per_voxel = 1 / transform.voxel_size;

  // Scale the direction, so that neither tiny nor huge ones over- or underflow below.
  const double scaled[3] = {ray.direction.x * per_voxel, ray.direction.y * per_voxel,
                            ray.direction.z * per_voxel};
  const double largest = std::max({std::fabs(scaled[0]), std::fabs(scaled[1]), std::fabs(scaled[2])});
  if (!(largest >= shortest && largest <= longest)) return false;
  const double scale = reciprocal_power(largest);

  // Mirror, clip to the slabs.
  frame.octant = 0;
  frame.t_per_s = scale;
  double enter = -std::numeric_limits<double>::infinity(), leave = std::numeric_limits<double>::infinity();
  int enter_axis = 0;
  double high[3];
  for (int a = 0; a < 3; ++a) {
    const double o = (ray.origin[a] - transform.origin[a]) * per_voxel, d = scaled[a] * scale;
    const double box_low = surface.node_min()[a] * double{node_dim};
    high[a] = surface.node_dims()[a] * double{node_dim};
    const bool mirror = std::signbit(d);
    frame.octant |= int{mirror} << a;
    frame.origin[a] = mirror ? (box_low + high[a]) - o : o - box_low;
    frame.direction[a] = mirror ? -d : d;
    frame.inverse[a] = 1 / std::max(frame.direction[a], 0x1p-100);
    const double slab_in = (0 - frame.origin[a]) * frame.inverse[a];
    const double slab_out = (high[a] - frame.origin[a]) * frame.inverse[a];
    if (!(slab_in <= slab_out)) return false; // NaN or infinite origin, or NaN direction
    if (slab_in > enter) {
      enter = slab_in;
      enter_axis = a;
    }
    leave = std::min(leave, slab_out);
  }

  // The interval in the scaled parameter, whose unit is t_per_s of the ray's own.
  const double per_t = 1 / scale; // exact, as scale is a power of two
  const double first = ray.t_min * per_t, last = ray.t_max * per_t;
  frame.from_outside = enter > first;
  const double start = frame.from_outside ? enter : first;
  const double stop = std::min(leave, last);
  if (!(start <= stop)) return false;
  // Where the ray leaves the box, its planes' times in the frame decide, which stop may miss by rounding:
  // cells end on the hull exactly, where samples are positive. So the end lies beyond it; the table has no
  // more nodes.
  frame.last = frame.end = leave < last ? std::min(stop - start + 1, last - start) : stop - start;
  frame.t_at_start = frame.from_outside ? start * scale : ray.t_min;

  // Begin there.
  for (int a = 0; a < 3; ++a) {
    frame.origin[a] += start * frame.direction[a];
    if (frame.from_outside && a == enter_axis) frame.origin[a] = 0;
    // The origin lies in the box but for rounding, so truncation is the floor once it is clamped.
    frame.start_node[a] =
        static_cast<int>(std::min(std::max(frame.origin[a], 0.0), high[a] - 0.5)) / node_dim;
  }
  return true;
}

} // namespace levelray
