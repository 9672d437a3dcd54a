#include "levelray/convert/link_components.hpp"

#include "levelray/convert/distance_kernel.hpp"

#include <bit>

namespace levelray {

namespace {

constexpr std::uint64_t low_faces[3] = {0x1111111111111111ull, 0x000F000F000F000Full, 0x000000000000FFFFull};
constexpr std::uint64_t high_faces[3] = {0x8888888888888888ull, 0xF000F000F000F000ull, 0xFFFF000000000000ull};

constexpr int step_of(int axis) {
  return 1 << (2 * axis);
} // bits to the next sample along an axis

// Bit s: samples s and s + step_of(axis) of the block are linked.
struct LinkMasks {
  std::uint64_t along[3] = {0, 0, 0};
};

LinkMasks link_masks(const float* distance) {
  LinkMasks links;
  pair_sums_above(distance, link_threshold, links.along);
  for (int axis = 0; axis < 3; ++axis) links.along[axis] &= ~high_faces[axis];
  return links;
}

Vec3i sample_at(const Vec3i& first_sample, int bit) {
  return first_sample + Vec3i(bit_x(bit), bit_y(bit), bit_z(bit));
}

// All samples that links connect to `seed`.
std::uint64_t flood(std::uint64_t seed, const LinkMasks& links) {
  for (;;) {
    std::uint64_t grown = seed;
    for (int axis = 0; axis < 3; ++axis) {
      const int step = step_of(axis);
      grown |= (grown & links.along[axis]) << step | (grown >> step & links.along[axis]);
    }
    if (grown == seed) return seed;
    seed = grown;
  }
}

// Adds the links between samples that no triangle lies between.
void link_across_nothing(LinkMasks& links, const VoxelMesh& mesh, std::span<const std::uint32_t> list,
                         const Vec3i& first_sample) {
  for (int axis = 0; axis < 3; ++axis)
    for (std::uint64_t rest = ~links.along[axis] & ~high_faces[axis]; rest; rest &= rest - 1) {
      const int bit = std::countr_zero(rest);
      if (cross_lattice_edge(mesh, list.data(), list.size(), sample_at(first_sample, bit), axis).triangles ==
          0)
        links.along[axis] |= std::uint64_t{1} << bit;
    }
}

// Gives each component its winding number relative to the first: a spanning tree of lattice edges between
// components. Returns the number of these edges that cross triangles in vain.
int count_windings(std::span<BlockComponent> components, const VoxelMesh& mesh,
                   std::span<const std::uint32_t> list, const Vec3i& first_sample) {
  const auto component_of = [&](int bit) -> BlockComponent& {
    std::size_t c = 0;
    while (!(components[c].samples >> bit & 1)) ++c;
    return components[c];
  };
  int thin = 0;
  std::uint64_t known = components[0].samples;
  while (~known) {
    for (int axis = 0; axis < 3; ++axis) {
      const int step = step_of(axis);
      const std::uint64_t upward = known & ~high_faces[axis] & ~(known >> step); // s known, s + step not
      const std::uint64_t downward = ~known & ~high_faces[axis] & known >> step; // s + step known, s not
      if (!(upward | downward)) continue;
      const int low = std::countr_zero(upward ? upward : downward);
      const Crossings crossed =
          cross_lattice_edge(mesh, list.data(), list.size(), sample_at(first_sample, low), axis);
      thin += crossed.triangles > 1 && crossed.winding == 0;
      BlockComponent &at_low = component_of(low), &at_high = component_of(low + step);
      if (upward)
        at_high.winding = at_low.winding + crossed.winding;
      else
        at_low.winding = at_high.winding - crossed.winding;
      known |= (upward ? at_high : at_low).samples;
      break;
    }
  }
  return thin;
}

} // namespace

std::uint64_t face_samples(int axis, int end) {
  return end ? high_faces[axis] : low_faces[axis];
}

int find_block_components(const float* distance, const VoxelMesh& mesh, std::span<const std::uint32_t> list,
                          const Vec3i& first_sample, SheetCounting counting,
                          std::vector<BlockComponent>& out) {
  LinkMasks links = link_masks(distance);
  if (counting == SheetCounting::touching) link_across_nothing(links, mesh, list, first_sample);

  const std::size_t first = out.size();
  for (std::uint64_t rest = ~std::uint64_t{0}; rest;) {
    const std::uint64_t samples = flood(rest & (~rest + 1), links);
    out.push_back({samples, 0, 0});
    rest &= ~samples;
  }
  if (counting != SheetCounting::windings) return 0;
  return count_windings({out.data() + first, out.size() - first}, mesh, list, first_sample);
}

FaceCrossing find_face_crossing(const float* distance, const VoxelMesh& mesh,
                                std::span<const std::uint32_t> list, const Vec3i& first_sample, int axis,
                                SheetCounting counting) {
  FaceCrossing crossing;
  if (counting == SheetCounting::none) return crossing;
  const std::uint64_t face = high_faces[axis];

  // A sample farther from the sheets than the threshold is linked to its neighbour whatever that one's
  // distance is.
  bool surely_linked = false;
  int nth = 0;
  for (std::uint64_t rest = face; rest; rest &= rest - 1, ++nth) {
    const int bit = std::countr_zero(rest);
    if (distance[bit] > link_threshold) {
      surely_linked = true;
    } else if (counting == SheetCounting::touching) {
      const Crossings c =
          cross_lattice_edge(mesh, list.data(), list.size(), sample_at(first_sample, bit), axis);
      crossing.free = static_cast<std::uint16_t>(crossing.free | (c.triangles == 0) << nth);
    }
  }
  if (counting == SheetCounting::windings && !surely_linked) {
    const int bit = std::countr_zero(face);
    crossing.winding =
        cross_lattice_edge(mesh, list.data(), list.size(), sample_at(first_sample, bit), axis).winding;
    crossing.tested = true;
  }
  return crossing;
}

} // namespace levelray
