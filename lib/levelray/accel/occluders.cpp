#include "levelray/accel/occluders.hpp"

#include "levelray/accel/box_masks.hpp"
#include "levelray/accel/node_walk.hpp"
#include "levelray/accel/visited_cell.hpp"
#include "levelray/core/bits.hpp"
#include "levelray/core/parallel.hpp"

#include <algorithm>
#include <atomic>

namespace levelray {

namespace {

// Table position (x,y,z) of entry `at`.
Vec3i position(const Vec3i& dims, std::size_t at) {
  const auto dx = static_cast<std::size_t>(dims.x), dy = static_cast<std::size_t>(dims.y);
  return Vec3i(static_cast<int>(at % dx), static_cast<int>(at / dx % dy), static_cast<int>(at / dx / dy));
}

std::uint64_t surface_blocks(const SurfaceBlocks& surface, std::size_t at) {
  return surface.leap(0, at) ? 0 : surface.node(at).blocks;
}

// The blocks of a node that lie inside and have no surface: all their 125 samples are negative, as a sample
// of another sign would make a surface cell.
std::uint64_t inside_blocks(const BlockGrid& grid, const Vec3i& node_coord, std::uint64_t with_surface) {
  const Vec3i sample = node_coord * node_dim;
  const std::uint32_t entry = grid.node_entry(sample.x, sample.y, sample.z);
  if (entry == BlockGrid::outside_node) return 0;
  if (entry == BlockGrid::inside_node) return ~with_surface;
  const BlockGrid::Node& node = grid.nodes[entry];
  std::uint64_t inside = node.inside & ~node.stored;
  std::size_t block = node.first_block;
  for (std::uint64_t rest = node.stored; rest; rest &= rest - 1, ++block)
    if (grid.values[block * samples_per_block] < 0) inside |= rest & (~rest + 1);
  return inside & ~with_surface;
}

constexpr int stride_of_axis[3] = {1, 4, 16};

} // namespace

Occluders::Occluders(const BlockGrid& grid, const SurfaceBlocks& surface) {
  const Vec3i dims = surface.node_dims();
  inside_.resize(static_cast<std::size_t>(dims.x) * static_cast<std::size_t>(dims.y) *
                 static_cast<std::size_t>(dims.z));
  parallel_for(inside_.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t at = begin; at < end; ++at)
      inside_[at] = inside_blocks(grid, surface.node_min() + position(dims, at), surface_blocks(surface, at));
  });
  consistent_ = check(surface);
  if (consistent_) find_boxes(surface);
}

// No inside block beside an outside block, nor at the hull of the table, beyond which everything is outside.
bool Occluders::check(const SurfaceBlocks& surface) const {
  const Vec3i dims = surface.node_dims();
  std::atomic<bool> good{true};
  parallel_for(inside_.size(), 4096, [&](std::size_t begin, std::size_t end) {
    bool fine = true;
    const std::size_t step[3] = {1, static_cast<std::size_t>(dims.x),
                                 static_cast<std::size_t>(dims.x) * static_cast<std::size_t>(dims.y)};
    const auto outside = [&](std::size_t at) { return ~(inside_[at] | surface_blocks(surface, at)); };
    for (std::size_t at = begin; at < end; ++at) {
      const std::uint64_t in = inside_[at], out = outside(at);
      const Vec3i p = position(dims, at);
      for (std::size_t a = 0; a < 3; ++a) {
        const int stride = stride_of_axis[a];
        const std::uint64_t first = layer_masks[a][0][0], last = layer_masks[a][3][3];
        // Within the node, each block with the next one along the axis.
        fine &= ((in & out >> stride & ~last) | (out & in >> stride & ~last)) == 0;
        // The last layer with the first one of the next node.
        const bool has_next = p[static_cast<int>(a)] + 1 < dims[static_cast<int>(a)];
        const std::uint64_t next_in = has_next ? inside_[at + step[a]] : 0,
                            next_out = has_next ? outside(at + step[a]) : ~std::uint64_t{0};
        fine &= ((in & next_out << 3 * stride & last) | (out & next_in << 3 * stride & last)) == 0;
        if (p[static_cast<int>(a)] == 0) fine &= (in & first) == 0;
      }
    }
    if (!fine) good = false;
  });
  return good;
}

bool Occluders::begins_outside(const SurfaceBlocks& surface, const RayFrame& ray) const {
  if (ray.from_outside) return true;
  const walk::NodeTable table(surface, ray.octant);
  int block[3], digit[3], node[3];
  for (int a = 0; a < 3; ++a) {
    const int cell =
        static_cast<int>(std::min(std::max(ray.origin[a], 0.0), table.dims[a] * double{node_dim} - 0.5));
    node[a] = cell >> 4, block[a] = cell >> 2 & 3, digit[a] = cell & 3;
  }
  const std::size_t entry = table.entry(node);
  const int mirrored = walk::mirrored_bits(ray.octant);
  const int bit = (block[0] | block[1] << 2 | block[2] << 4) ^ mirrored;
  if (!(surface_blocks(surface, entry) >> bit & 1)) return !(inside_[entry] >> bit & 1);

  // In a surface block the value decides: in a surface cell the interpolated one, as in the walk, else any
  // corner's sign.
  const SurfaceBlocks::Node& found = surface.node(entry);
  const std::size_t index = found.first + count_bits(found.blocks & ((std::uint64_t{1} << bit) - 1));
  const int corner[3] = {16 * node[0] + 4 * block[0], 16 * node[1] + 4 * block[1],
                         16 * node[2] + 4 * block[2]};
  const walk::PlaneTimes times(ray, corner, 1);
  VisitedCell cell;
  cell.in = 0;
  cell.out = times.out(digit[0], digit[1], digit[2], ray.end);
  walk::CellReader(ray.octant).read(ray, times, corner, digit, surface.record(index), cell);
  const int cell_bit = (digit[0] | digit[1] << 2 | digit[2] << 4) ^ mirrored;
  if (!(surface.cells(index) >> cell_bit & 1)) return cell.segment.corner[0] > 0;
  return !(interpolate(cell.segment.corner, cell.segment.in) < 0);
}

bool meets(const SurfaceBlocks& surface, const RayFrame& ray, const Occluders::Box& box) {
  double in = 0, out = ray.end;
  for (int a = 0; a < 3; ++a) {
    const int size = surface.node_dims()[a] * 4;
    const bool mirrored = ray.octant >> a & 1;
    const int low = mirrored ? size - box.end[a] : box.low[a],
              end = mirrored ? size - box.low[a] : box.end[a];
    in = std::max(in, walk::plane_time(ray, a, low * block_dim));
    out = std::min(out, walk::plane_time(ray, a, end * block_dim));
  }
  return in <= out;
}

} // namespace levelray
