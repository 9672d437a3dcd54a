// The walk along a ray against brute force over all cells, which shares no code with it.
#include "levelray/accel/cell_walk.hpp"
#include "support/catch.hpp"
#include "support/trace_fixtures.hpp"

#include <array>
#include <map>

using namespace levelray;
using namespace levelray::test;

namespace {

using Cell = std::array<int, 3>;

// A scattering of blocks, some in clusters, over three different extents with negative indices; random masks.
BlockGrid scattered_grid(unsigned seed, double density) {
  RandomRays random(seed);
  BlockGrid grid;
  grid.background = 3;
  grid.node_min = Vec3i(-3, -1, 2);
  grid.node_dims = Vec3i(5, 3, 4);
  for (int z = 0; z < 4; ++z)
    for (int y = 0; y < 3; ++y)
      for (int x = 0; x < 5; ++x) {
        BlockGrid::Node node;
        node.coord = grid.node_min + Vec3i(x, y, z);
        node.first_block = grid.active.size();
        if (random.uniform(0, 1) < density)
          for (int bit = 0; bit < 64; ++bit) {
            if (random.uniform(0, 1) > 0.2) continue;
            node.stored |= std::uint64_t{1} << bit;
            std::uint64_t cells = 0;
            for (int c = 0; c < 64; ++c) cells |= std::uint64_t{random.uniform(0, 1) < 0.15} << c;
            grid.cells.push_back(cells);
            grid.active.push_back(~std::uint64_t{0});
            for (int s = 0; s < samples_per_block; ++s)
              grid.values.push_back(static_cast<float>(random.uniform(-1, 1)));
          }
        if (node.stored) {
          grid.node_table.push_back(static_cast<std::uint32_t>(grid.nodes.size()));
          grid.nodes.push_back(node);
        } else {
          grid.node_table.push_back(BlockGrid::outside_node);
        }
      }
  return grid;
}

std::vector<Cell> surface_cells(const BlockGrid& grid) {
  std::vector<Cell> cells;
  for (const BlockGrid::Node& node : grid.nodes)
    for (int bit = 0; bit < 64; ++bit) {
      if (!(node.stored >> bit & 1)) continue;
      for (int c = 0; c < 64; ++c)
        if (grid.cells[BlockGrid::block_index(node, bit)] >> c & 1)
          cells.push_back({16 * node.coord.x + 4 * bit_x(bit) + bit_x(c),
                           16 * node.coord.y + 4 * bit_y(bit) + bit_y(c),
                           16 * node.coord.z + 4 * bit_z(bit) + bit_z(c)});
    }
  return cells;
}

// The length of a ray's piece in a cell that is moved outwards (or inwards) by `margin`; negative: it misses.
double length_in(const WorldRay& ray, const Cell& cell, double margin) {
  double in = ray.t_min, out = ray.t_max;
  for (int a = 0; a < 3; ++a) {
    const double low = cell[static_cast<std::size_t>(a)] - margin,
                 high = cell[static_cast<std::size_t>(a)] + 1 + margin;
    if (ray.direction[a] == 0) {
      if (ray.origin[a] < low || ray.origin[a] > high) return -1;
      continue;
    }
    const double t0 = (low - ray.origin[a]) / ray.direction[a],
                 t1 = (high - ray.origin[a]) / ray.direction[a];
    in = std::max(in, std::min(t0, t1));
    out = std::min(out, std::max(t0, t1));
  }
  return out - in;
}

struct Visits {
  std::map<Cell, int> count;
  bool in_order = true, joined = true, right_corners = true;
};

Visits walk(const BlockGrid& grid, const SurfaceBlocks& surface, const WorldRay& ray) {
  Visits visits;
  RayFrame frame;
  if (!enter_box(surface, grid.transform, ray, frame)) return visits;
  WalkCounts counts;
  double last = 0;
  walk_cells(surface, frame, counts, [&](const VisitedCell& cell) {
    Cell at;
    for (int a = 0; a < 3; ++a) {
      const int low = surface.node_min()[a] * node_dim, size = surface.node_dims()[a] * node_dim;
      at[static_cast<std::size_t>(a)] =
          low + (frame.octant >> a & 1 ? size - 1 - cell.position[a] : cell.position[a]);
    }
    ++visits.count[at];
    visits.in_order &= cell.in >= last && cell.in <= cell.out;
    last = cell.in;
    for (int c = 0; c < 8; ++c) {
      int sample[3];
      for (int a = 0; a < 3; ++a)
        sample[a] = at[static_cast<std::size_t>(a)] + ((c >> a & 1) ^ (frame.octant >> a & 1));
      visits.right_corners &= cell.segment.corner[c] == grid.value(sample[0], sample[1], sample[2]);
    }
    // The ends lie on the ray, within rounding of coordinates below 2^8, and in the cell.
    for (int a = 0; a < 3; ++a)
      for (const auto& [end, s] :
           {std::pair{cell.segment.in, cell.in}, std::pair{cell.segment.out, cell.out}}) {
        const double p = ray.at(frame.t(s))[a] - at[static_cast<std::size_t>(a)];
        const double local = frame.octant >> a & 1 ? end.rest[a] : end.x[a];
        visits.joined &= std::fabs(local - p) < 1e-10 && end.x[a] >= 0 && end.x[a] <= 1;
      }
    return false;
  });
  return visits;
}

// Every cell whose shrunken cube the ray meets is visited once; none is whose grown cube it does not meet.
// The margin is the rounding of coordinates below 2^8 over a few operations.
void check_walk(const BlockGrid& grid, const SurfaceBlocks& surface, const std::vector<Cell>& cells,
                const WorldRay& ray) {
  constexpr double margin = 1e-11;
  const Visits visits = walk(grid, surface, ray);
  CAPTURE(ray.origin, ray.direction, ray.t_min, ray.t_max);
  CHECK(visits.in_order);
  CHECK(visits.right_corners);
  CHECK(visits.joined);
  std::size_t wrong = 0, known = 0;
  for (const Cell& cell : cells) {
    const auto found = visits.count.find(cell);
    const int count = found == visits.count.end() ? 0 : found->second;
    known += count > 0;
    wrong += count > 1;
    wrong += count == 0 && length_in(ray, cell, -margin) > 0;
    wrong += count > 0 && length_in(ray, cell, margin) < 0;
  }
  CHECK(wrong == 0);
  CHECK(known == visits.count.size()); // nothing but surface cells
}

} // namespace

TEST_CASE("the walk visits every surface cell on a random ray once, front to back") {
  for (const unsigned seed : {1u, 2u, 3u}) {
    CAPTURE(seed);
    const BlockGrid grid = scattered_grid(seed, seed == 3 ? 0.1 : 0.5);
    const SurfaceBlocks surface(grid);
    const std::vector<Cell> cells = surface_cells(grid);
    RandomRays random(seed + 100);
    const Box3d box(Vec3d(-48, -16, 32), Vec3d(32, 32, 96));
    for (int i = 0; i < 300; ++i) {
      WorldRay ray = random.through(box);
      if (i % 3 == 1) ray.origin = random.in_box(box);
      if (i % 3 == 2) ray.t_min = random.uniform(0, 300), ray.t_max = random.uniform(0, 300);
      ray.direction *= random.uniform(0.1, 10);
      check_walk(grid, surface, cells, ray);
    }
  }
}

TEST_CASE("the walk visits the cells along axes, face planes, edges and diagonals of the lattice") {
  const BlockGrid grid = scattered_grid(7, 0.6);
  const SurfaceBlocks surface(grid);
  const std::vector<Cell> cells = surface_cells(grid);
  RandomRays random(8);
  const Box3d box(Vec3d(-48, -16, 32), Vec3d(32, 32, 96));
  for (int i = 0; i < 400; ++i) {
    WorldRay ray;
    for (int a = 0; a < 3; ++a) {
      // Components of -1, 0, -0 or 1; origins on samples, half-way between, or anywhere.
      const double choices[] = {-1, 0, -0.0, 1};
      ray.direction[a] = choices[static_cast<int>(random.uniform(0, 4))];
      const double p = random.in_box(box)[a];
      const int kind = static_cast<int>(random.uniform(0, 3));
      ray.origin[a] = kind == 0 ? std::floor(p) : kind == 1 ? std::floor(p) + 0.5 : p;
    }
    ray.t_min = -std::numeric_limits<double>::infinity();
    if (i % 2) ray.t_min = -30;
    check_walk(grid, surface, cells, ray);
  }
}

TEST_CASE("leaps cross the largest empty cube ahead and no more") {
  const BlockGrid grid = scattered_grid(11, 0.12);
  const SurfaceBlocks surface(grid);
  REQUIRE_FALSE(surface.empty());
  const Vec3i dims = surface.node_dims();
  const auto occupied = [&](int x, int y, int z) {
    const std::uint32_t entry = grid.node_entry(
        16 * (surface.node_min().x + x), 16 * (surface.node_min().y + y), 16 * (surface.node_min().z + z));
    if (entry >= BlockGrid::inside_node) return false;
    const BlockGrid::Node& node = grid.nodes[entry];
    for (int bit = 0; bit < 64; ++bit)
      if (node.stored >> bit & 1 && grid.cells[BlockGrid::block_index(node, bit)]) return true;
    return false;
  };
  for (int octant = 0; octant < 8; ++octant)
    for (int z = 0; z < dims.z; ++z)
      for (int y = 0; y < dims.y; ++y)
        for (int x = 0; x < dims.x; ++x) {
          int edge = 0; // of the largest empty cube, by trying all
          for (bool empty = true; empty && edge < 255;) {
            for (int k = 0; k <= edge && empty; ++k)
              for (int j = 0; j <= edge && empty; ++j)
                for (int i = 0; i <= edge && empty; ++i) {
                  const int px = x + (octant & 1 ? -i : i), py = y + (octant & 2 ? -j : j),
                            pz = z + (octant & 4 ? -k : k);
                  empty = px < 0 || py < 0 || pz < 0 || px >= dims.x || py >= dims.y || pz >= dims.z ||
                          !occupied(px, py, pz);
                }
            if (edge > 5)
              edge = 255; // beyond the table in all directions
            else if (empty)
              ++edge;
          }
          const int leap = surface.leap(octant, static_cast<std::size_t>(x + dims.x * (y + dims.y * z)));
          CHECK((leap == edge || (edge == 255 && leap >= 6)));
        }
}

TEST_CASE("a level set of nothing is empty, and every ray misses it") {
  BlockGrid grid;
  grid.background = 1;
  const SurfaceBlocks surface(grid);
  CHECK(surface.empty());
  RayFrame frame;
  CHECK_FALSE(enter_box(surface, grid.transform, WorldRay{}, frame));
}
