#include "levelray/vdb/to_openvdb.hpp"

#include "levelray/core/error.hpp"
#include "levelray/core/parallel.hpp"
#include "levelray/vdb/vdb_file.hpp"

#include <cmath>
#include <fmt/format.h>
#include <map>
#include <memory>
#include <vector>

namespace levelray {

namespace {

using Tree = openvdb::FloatTree; // root / 32^3 x 16^3 x 8^3
using Leaf = Tree::LeafNodeType;
using Inner = Tree::RootNodeType::ChildNodeType::ChildNodeType; // 128^3 samples
using Upper = Tree::RootNodeType::ChildNodeType;                // 4096^3 samples

constexpr int nodes_per_inner = 8; // our nodes along an edge of an Inner node

openvdb::Coord to_coord(const Vec3i& v) {
  return {v.x, v.y, v.z};
}

// Copies one of our blocks to its octant of a leaf, whose values run z fastest.
void fill_octant(Leaf& leaf, int octant, const float* values, std::uint64_t active) {
  float* out = leaf.buffer().data();
  const openvdb::Index base =
      static_cast<openvdb::Index>((octant & 1) << 8 | (octant >> 1 & 1) << 5 | (octant >> 2) << 2);
  for (openvdb::Index x = 0; x < 4; ++x)
    for (openvdb::Index y = 0; y < 4; ++y)
      for (openvdb::Index z = 0; z < 4; ++z) {
        const openvdb::Index from = x | y << 2 | z << 4, to = base + (x << 6 | y << 3 | z);
        out[to] = values[from];
        if (active >> from & 1) leaf.setValueOnly(to, values[from]), leaf.setActiveState(to, true);
      }
}

// The leaf, tile or nothing for the 8^3 samples at `octant` of a node.
void add_octant(Inner& inner, const BlockGrid& grid, const BlockGrid::Node& node, int octant) {
  const Vec3i half(octant & 1, octant >> 1 & 1, octant >> 2);
  int inside = 0, stored = 0;
  const auto bit_of = [&](int o) {
    return (2 * half.x + (o & 1)) | (2 * half.y + (o >> 1 & 1)) << 2 | (2 * half.z + (o >> 2)) << 4;
  };
  for (int o = 0; o < 8; ++o) {
    stored += static_cast<int>(node.stored >> bit_of(o) & 1);
    inside += static_cast<int>(node.inside >> bit_of(o) & 1);
  }
  if (stored == 0 && inside == 0) return;
  const openvdb::Coord origin = to_coord(node.coord * node_dim + half * 8);
  if (inside == 8) {
    inner.addTile(Inner::coordToOffset(origin), -grid.background, false);
    return;
  }
  auto leaf = std::make_unique<Leaf>(origin, grid.background, false);
  leaf->allocate();
  for (int o = 0; o < 8; ++o) {
    const int bit = bit_of(o);
    if (node.stored >> bit & 1) {
      const std::size_t block = BlockGrid::block_index(node, bit);
      fill_octant(*leaf, o, &grid.values[block * samples_per_block], grid.active[block]);
    } else if (node.inside >> bit & 1) {
      float values[samples_per_block];
      std::fill_n(values, samples_per_block, -grid.background);
      fill_octant(*leaf, o, values, 0);
    }
  }
  inner.addChild(leaf.release());
}

// What a cube of 128^3 samples is.
struct Region {
  std::unique_ptr<Inner> node; // null: a tile
  bool inside = false;
};

Region make_region(const BlockGrid& grid, const Vec3i& region) {
  constexpr int count = nodes_per_inner * nodes_per_inner * nodes_per_inner;
  const Vec3i first = region * nodes_per_inner;
  std::uint32_t entries[count];
  int inside = 0, outside = 0;
  for (int n = 0; n < count; ++n) {
    const Vec3i sample = (first + Vec3i(n & 7, n >> 3 & 7, n >> 6)) * node_dim;
    entries[n] = grid.node_entry(sample.x, sample.y, sample.z);
    inside += entries[n] == BlockGrid::inside_node;
    outside += entries[n] == BlockGrid::outside_node;
  }
  Region result;
  result.inside = inside == count;
  if (result.inside || outside == count) return result;

  result.node = std::make_unique<Inner>(to_coord(first * node_dim), grid.background, false);
  for (int n = 0; n < count; ++n) {
    if (entries[n] == BlockGrid::outside_node) continue;
    for (int octant = 0; octant < 8; ++octant) {
      if (entries[n] < BlockGrid::inside_node) {
        add_octant(*result.node, grid, grid.nodes[entries[n]], octant);
      } else {
        const Vec3i sample = (first + Vec3i(n & 7, n >> 3 & 7, n >> 6)) * node_dim +
                             Vec3i(octant & 1, octant >> 1 & 1, octant >> 2) * 8;
        result.node->addTile(Inner::coordToOffset(to_coord(sample)), -grid.background, false);
      }
    }
  }
  return result;
}

Tree::Ptr make_tree(const BlockGrid& grid) {
  auto tree = std::make_shared<Tree>(grid.background);
  if (grid.node_table.empty()) return tree;

  // Make the cubes of 128^3 samples in parallel.
  Vec3i first, count;
  for (int a = 0; a < 3; ++a) {
    first[a] = grid.node_min[a] >> 3;
    count[a] = ((grid.node_min[a] + grid.node_dims[a] - 1) >> 3) - first[a] + 1;
  }
  const std::size_t nx = static_cast<std::size_t>(count.x), ny = static_cast<std::size_t>(count.y);
  std::vector<Region> regions(nx * ny * static_cast<std::size_t>(count.z));
  const auto coord_of = [&](std::size_t i) {
    return first +
           Vec3i(static_cast<int>(i % nx), static_cast<int>(i / nx % ny), static_cast<int>(i / nx / ny));
  };
  parallel_for(regions.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) regions[i] = make_region(grid, coord_of(i));
  });

  // Hang them into the upper levels; a wholly inside upper node becomes a tile of the root.
  struct Slot {
    std::unique_ptr<Upper> node;
    openvdb::Index inside_tiles = 0;
  };
  std::map<openvdb::Coord, Slot> uppers;
  for (std::size_t i = 0; i < regions.size(); ++i) {
    if (!regions[i].node && !regions[i].inside) continue;
    const openvdb::Coord origin = to_coord(coord_of(i) * (nodes_per_inner * node_dim));
    Slot& slot = uppers[origin & ~openvdb::Int32(Upper::DIM - 1)];
    if (!slot.node) slot.node = std::make_unique<Upper>(origin, grid.background, false);
    if (regions[i].node)
      slot.node->addChild(regions[i].node.release());
    else
      slot.node->addTile(Upper::coordToOffset(origin), -grid.background, false), ++slot.inside_tiles;
  }
  for (auto& [origin, slot] : uppers) {
    if (slot.inside_tiles == Upper::NUM_VALUES)
      tree->root().addTile(origin, -grid.background, false);
    else
      tree->root().addChild(slot.node.release());
  }
  return tree;
}

} // namespace

namespace {

// OpenVDB 10 (math/Maps.h, ScaleMap) takes a map as singular when the product of its three scales is below
// 3e-15.
double smallest_volume() {
  return 3 * openvdb::math::Tolerance<double>::value();
}

} // namespace

double smallest_vdb_voxel_size() {
  return std::cbrt(smallest_volume()) * (1 + 1e-12);
}

void check_vdb_voxel_size(double voxel_size) {
  if (!(voxel_size * voxel_size * voxel_size >= smallest_volume()))
    throw Error(
        ErrorKind::limit,
        fmt::format("OpenVDB cannot represent voxels of {:.6g}: the smallest are {:.4g}; scale the mesh up, "
                    "for example from metres to millimetres",
                    voxel_size, std::cbrt(smallest_volume())));
}

openvdb::FloatGrid::Ptr to_openvdb(const BlockGrid& grid) {
  const double h = grid.transform.voxel_size;
  check_vdb_voxel_size(h);
  openvdb::FloatGrid::Ptr out = openvdb::FloatGrid::create(make_tree(grid));
  openvdb::math::Transform::Ptr transform = openvdb::math::Transform::createLinearTransform(h);
  const Vec3d& o = grid.transform.origin;
  if (o != Vec3d(0, 0, 0)) transform->postTranslate(openvdb::Vec3d(o.x, o.y, o.z));
  out->setTransform(transform);
  out->setGridClass(openvdb::GRID_LEVEL_SET);
  out->setName(grid.name);
  return out;
}

void initialize_openvdb() {
  openvdb::initialize(); // guards itself against repetition and threads
}

} // namespace levelray
