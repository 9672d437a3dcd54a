#include "levelray/convert/redistance.hpp"

#include "levelray/convert/assemble.hpp"
#include "levelray/convert/zero_set.hpp"
#include "levelray/core/error.hpp"
#include "levelray/core/parallel.hpp"
#include "levelray/grid/complete_blocks.hpp"

#include <atomic>
#include <bit>
#include <chrono>
#include <cmath>
#include <fmt/format.h>
#include <memory>
#include <numeric>

namespace levelray {

namespace {

constexpr double wanted_error = 1.0 / 128; // voxels
// A cell of 4^3 has up to 400 triangles, and a node lists those of all cells around it: finer ones would cost
// more memory than the grid.
constexpr int most_divisions = 4;

bool is_inside(float value) {
  return value < 0;
}

// How finely to divide a cell so that zero_set.hpp's bound, 3/(8 n^2) M / |grad|, is what we want. M is
// bounded by the sum of the mixed second derivatives, each of which is largest on one of two opposite edges;
// the gradient is the one at the cell's centre. Where that is too small, the finest division must do. Cells
// of different divisions leave slits in the surface, as wide as the error: distances do not mind, and signs
// do not come from the triangles.
int divisions_for(const std::array<float, 8>& f) {
  double gradient_square = 0, mixed = 0;
  for (int a = 0; a < 3; ++a) {
    const std::size_t u = std::size_t{1} << a, v = std::size_t{1} << (a + 1) % 3,
                      w = std::size_t{1} << (a + 2) % 3;
    double slope = 0;
    for (const std::size_t c : {std::size_t{0}, v, w, v + w}) slope += (double{f[c + u]} - double{f[c]}) / 4;
    gradient_square += slope * slope;
    const double low = double{f[u + v]} - double{f[u]} - double{f[v]} + double{f[0]};
    const double high = double{f[u + v + w]} - double{f[u + w]} - double{f[v + w]} + double{f[w]};
    mixed += std::max(std::fabs(low), std::fabs(high));
  }
  const double squared = 3 * mixed / (8 * wanted_error * std::sqrt(gradient_square));
  for (int n = 1; n < most_divisions; ++n)
    if (squared <= n * n) return n; // false for NaN: a cell without a gradient
  return most_divisions;
}

// Calls visit(lowest corner, corner values) for the cells with samples of both sides whose lowest corner lies
// in the box, in the order of nodes, blocks and cells.
template <class Visit>
void for_surface_cells(const BlockGrid& grid, const Vec3i& low, const Vec3i& high, const Visit& visit) {
  for (int nz = low.z >> 4; nz <= high.z >> 4; ++nz)
    for (int ny = low.y >> 4; ny <= high.y >> 4; ++ny)
      for (int nx = low.x >> 4; nx <= high.x >> 4; ++nx) {
        const std::uint32_t entry = grid.node_entry(nx * node_dim, ny * node_dim, nz * node_dim);
        if (entry >= BlockGrid::inside_node) continue;
        const BlockGrid::Node& node = grid.nodes[entry];
        for (std::uint64_t blocks = node.stored; blocks; blocks &= blocks - 1) {
          const int b = std::countr_zero(blocks);
          const Vec3i first = node.coord * node_dim + Vec3i(bit_x(b), bit_y(b), bit_z(b)) * block_dim;
          bool near = true;
          for (int a = 0; a < 3; ++a) near = near && first[a] <= high[a] && first[a] + block_dim > low[a];
          if (!near) continue;
          for (std::uint64_t cells = grid.cells[BlockGrid::block_index(node, b)]; cells; cells &= cells - 1) {
            const int s = std::countr_zero(cells);
            const Vec3i p = first + Vec3i(bit_x(s), bit_y(s), bit_z(s));
            bool within = true;
            for (int a = 0; a < 3; ++a) within = within && low[a] <= p[a] && p[a] <= high[a];
            if (!within) continue;
            std::array<float, 8> corners;
            int inside = 0;
            for (int c = 0; c < 8; ++c) {
              const float v = grid.value(p.x + (c & 1), p.y + (c >> 1 & 1), p.z + (c >> 2));
              corners[static_cast<std::size_t>(c)] = v;
              inside += is_inside(v);
            }
            if (inside > 0 && inside < 8) visit(p, corners);
          }
        }
      }
}

// The samples of a node that lie inside.
NodeSides sides_of(const BlockGrid& grid, const Vec3i& coord) {
  NodeSides sides;
  const std::uint32_t entry = grid.node_entry(coord.x * node_dim, coord.y * node_dim, coord.z * node_dim);
  if (entry >= BlockGrid::inside_node) {
    sides.inside = entry == BlockGrid::inside_node;
    return sides;
  }
  const BlockGrid::Node& node = grid.nodes[entry];
  sides.blocks.resize(64);
  for (int b = 0; b < 64; ++b) {
    std::uint64_t inside = node.inside >> b & 1 ? ~std::uint64_t{0} : 0;
    if (node.stored >> b & 1) {
      const float* values = &grid.values[BlockGrid::block_index(node, b) * samples_per_block];
      for (int s = 0; s < samples_per_block; ++s) inside |= std::uint64_t{is_inside(values[s])} << s;
    }
    sides.blocks[static_cast<std::size_t>(b)] = inside;
  }
  return sides;
}

// What the new grid says of the places where the source's surface crosses the lattice's edges.
void measure_moves(const BlockGrid& before, const BlockGrid& after, RedistanceReport& report) {
  struct Moves {
    std::uint64_t crossings = 0;
    double squares = 0, largest = 0;
  };
  constexpr std::size_t chunk = 16; // nodes
  std::vector<Moves> chunks((before.nodes.size() + chunk - 1) / chunk);
  parallel_for(before.nodes.size(), chunk, [&](std::size_t begin, std::size_t end) {
    Moves moves;
    for (std::size_t n = begin; n < end; ++n) {
      const Vec3i low = before.nodes[n].coord * node_dim;
      for_surface_cells(
          before, low, low + Vec3i(node_dim - 1), [&](const Vec3i& p, const std::array<float, 8>& f) {
            for (int axis = 0; axis < 3; ++axis) { // the cell's edges at its lowest corner
              const double a = f[0], b = f[std::size_t{1} << axis];
              if ((a < 0) == (b < 0)) continue;
              Vec3i q = p;
              q[axis] += 1;
              const double c = after.value(p.x, p.y, p.z), d = after.value(q.x, q.y, q.z), t = a / (a - b);
              const double moved = std::fabs((1 - t) * c + t * d) / after.transform.voxel_size;
              ++moves.crossings;
              moves.squares += moved * moved;
              moves.largest = std::max(moves.largest, moved);
            }
          });
    }
    chunks[begin / chunk] = moves;
  });
  double squares = 0;
  for (const Moves& m : chunks) {
    report.crossings += m.crossings;
    squares += m.squares;
    report.largest_moved_voxels = std::max(report.largest_moved_voxels, m.largest);
  }
  if (report.crossings) report.rms_moved_voxels = std::sqrt(squares / static_cast<double>(report.crossings));
}

} // namespace

BlockGrid redistance(const BlockGrid& source, const RedistanceOptions& options, RedistanceReport* report) {
  const auto start = std::chrono::steady_clock::now();
  if (!(options.half_width_voxels >= 1 && options.half_width_voxels <= 1000))
    throw Error(ErrorKind::usage,
                fmt::format("the band's half-width must be between 1 and 1000 voxels, not {}",
                            options.half_width_voxels));
  const double reach = std::max(options.half_width_voxels, sign_reach);
  const int spread = static_cast<int>(std::ceil(reach)) + 1; // a cell's triangles reach its far corner

  // The nodes that the band may touch, and one more on each side.
  Band band;
  const int more = (spread + node_dim - 1) / node_dim + 1;
  band.box = {source.node_min - Vec3i(more), source.node_dims + Vec3i(2 * more)};
  const std::size_t count = band.box.count();
  if (options.max_memory > 0 && !(static_cast<double>(count) * 64 <= static_cast<double>(options.max_memory)))
    throw Error(ErrorKind::limit,
                fmt::format("redistancing {} x {} x {} nodes of 16^3 samples needs more memory than "
                            "allowed (--max-memory)",
                            band.box.dims.x, band.box.dims.y, band.box.dims.z));

  BandOptions band_options;
  band_options.half_width_voxels = options.half_width_voxels;
  band_options.find_components = false;
  std::vector<std::unique_ptr<NodeBand>> nodes(count); // most of the box is empty
  std::vector<NodeSides> sides(count);
  std::atomic<std::size_t> done{0};
  std::atomic<std::uint64_t> bytes{0}, cells{0};
  parallel_for(count, 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) {
      const Vec3i coord = band.box.coord(n), low = coord * node_dim, high = low + Vec3i(node_dim - 1);
      sides[n] = sides_of(source, coord);
      VoxelMesh mesh;
      TriangleMesh triangles;
      for_surface_cells(source, low - Vec3i(spread), high + Vec3i(spread - 1),
                        [&](const Vec3i& p, const std::array<float, 8>& corners) {
                          append_zero_set(corners, Vec3d(p.x, p.y, p.z), divisions_for(corners), triangles);
                          bool own = true;
                          for (int a = 0; a < 3; ++a) own = own && low[a] <= p[a] && p[a] <= high[a];
                          if (own) ++cells;
                        });
      if (triangles.triangles.empty()) continue;
      mesh.vertices = std::move(triangles.vertices);
      mesh.triangles = std::move(triangles.triangles);
      mesh.surface_count = mesh.triangles.size();
      std::vector<std::uint32_t> all(mesh.surface_count);
      std::iota(all.begin(), all.end(), 0u);
      nodes[n] = std::make_unique<NodeBand>(make_node_band(mesh, coord, all, band_options));
      // Twice: of the band and of the grid that is made of it.
      const std::uint64_t sum = bytes += 2 * nodes[n]->distance.size() * sizeof(float);
      if (options.max_memory > 0 && sum > options.max_memory)
        throw Error(ErrorKind::limit, "redistancing needs more memory than allowed (--max-memory)");
    }
    if (options.progress)
      options.progress(static_cast<double>(done += end - begin) / static_cast<double>(count));
  });
  if (cells == 0)
    throw Error(ErrorKind::bad_input, "has no surface: no two neighbouring samples differ in sign");

  band.node_at.assign(count, Band::untouched);
  for (std::size_t n = 0; n < count; ++n) {
    if (!nodes[n] || nodes[n]->kept == 0) continue;
    band.node_at[n] = static_cast<std::int32_t>(band.nodes.size());
    band.nodes.push_back(std::move(*nodes[n]));
    nodes[n].reset();
  }
  std::uint64_t inside_samples = 0;
  BlockGrid result = assemble_grid(band, sides, source.transform, options.half_width_voxels, &inside_samples);
  result.name = source.name;
  if (report) {
    *report = {};
    report->surface_cells = cells;
    measure_moves(source, result, *report);
    report->before = field_facts(source);
    report->after = field_facts(result);
    report->ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  }
  return result;
}

} // namespace levelray
