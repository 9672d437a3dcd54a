#include "levelray/vdb/grid_stream.hpp"

#include <cmath>
#include <cstring>

namespace levelray {

namespace {

constexpr std::uint64_t layout = 0x31644972676C7276; // changes with what is sent

constexpr int node_limit = 1 << 27; // node coordinates, so that samples fit 32 bits

struct NodeMasks {
  std::uint64_t stored, inside;
};

void send_grid(StreamOut& out, const BlockGrid& grid) {
  for (int a = 0; a < 3; ++a) {
    out.value(grid.transform.origin[a]);
    out.value(std::int32_t{grid.node_min[a]});
    out.value(std::int32_t{grid.node_dims[a]});
  }
  out.value(grid.transform.voxel_size);
  out.value(grid.background);
  out.text(grid.name);
  out.value(std::uint64_t{grid.nodes.size()});
  out.value(std::uint64_t{grid.block_count()});
  out.array(grid.node_table);
  for (const BlockGrid::Node& node : grid.nodes) out.value(NodeMasks{node.stored, node.inside});
  out.array(grid.values);
  out.array(grid.active);
}

void receive_table(StreamIn& in, BlockGrid& grid, std::uint64_t nodes, std::uint64_t blocks,
                   std::uint64_t entries) {
  in.array(grid.node_table, entries);
  std::vector<NodeMasks> masks;
  in.array(masks, nodes);
  grid.nodes.reserve(nodes);
  std::uint64_t first_block = 0;
  const std::uint64_t nx = static_cast<std::uint64_t>(grid.node_dims.x),
                      ny = static_cast<std::uint64_t>(grid.node_dims.y);
  for (std::uint64_t i = 0; i < entries; ++i) {
    if (grid.node_table[i] >= BlockGrid::inside_node) continue;
    in.check(grid.nodes.size() < nodes && grid.node_table[i] == grid.nodes.size(), "the node table");
    BlockGrid::Node node;
    node.coord = grid.node_min + Vec3i(static_cast<int>(i % nx), static_cast<int>(i / nx % ny),
                                       static_cast<int>(i / nx / ny));
    node.stored = masks[grid.nodes.size()].stored;
    node.inside = masks[grid.nodes.size()].inside;
    node.first_block = first_block;
    in.check((node.stored & node.inside) == 0, "a node's masks");
    first_block += static_cast<std::uint64_t>(std::popcount(node.stored));
    grid.nodes.push_back(node);
  }
  in.check(grid.nodes.size() == nodes && first_block == blocks, "the number of blocks");
}

BlockGrid receive_grid(StreamIn& in, std::uint64_t max_bytes) {
  BlockGrid grid;
  double entries = 1;
  for (int a = 0; a < 3; ++a) {
    grid.transform.origin[a] = in.value<double>();
    grid.node_min[a] = in.value<std::int32_t>();
    grid.node_dims[a] = in.value<std::int32_t>();
    in.check(std::isfinite(grid.transform.origin[a]), "the origin");
    in.check(grid.node_min[a] >= -node_limit && grid.node_min[a] <= node_limit && grid.node_dims[a] >= 1 &&
                 grid.node_dims[a] <= node_limit - grid.node_min[a],
             "the extent");
    entries *= grid.node_dims[a];
  }
  grid.transform.voxel_size = in.value<double>();
  grid.background = in.value<float>();
  in.check(std::isfinite(grid.transform.voxel_size) && grid.transform.voxel_size > 0, "the voxel size");
  in.check(std::isfinite(grid.background) && grid.background > 0, "the background");
  grid.name = in.text();
  const auto nodes = in.value<std::uint64_t>(), blocks = in.value<std::uint64_t>();

  // 16 bytes a block for the two masks; nodes are held twice for a moment.
  const double bytes = entries * sizeof(std::uint32_t) +
                       static_cast<double>(nodes) * (sizeof(BlockGrid::Node) + sizeof(NodeMasks)) +
                       static_cast<double>(blocks) * (samples_per_block * sizeof(float) + 16.0);
  if (!(bytes <= static_cast<double>(max_bytes) * 1.1)) in.fail("a size beyond the limit");
  receive_table(in, grid, nodes, blocks, static_cast<std::uint64_t>(entries));

  in.array(grid.values, blocks * samples_per_block);
  in.array(grid.active, blocks);
  for (std::uint64_t b = 0; b < blocks; ++b)
    for (std::uint64_t s = 0; s < samples_per_block; ++s) {
      float& v = grid.values[b * samples_per_block + s];
      v += 0.0f; // -0 becomes +0
      in.check(std::isfinite(v) && (grid.active[b] >> s & 1 || std::fabs(v) == grid.background), "a value");
    }
  return grid;
}

} // namespace

void send_file(const ByteSink& write, const VdbFile& file, bool with_grid) {
  StreamOut out(write, layout);
  const std::uint32_t grids = out.count(file.grids.size());
  for (std::uint32_t i = 0; i < grids; ++i) {
    const VdbGridInfo& info = file.grids[i];
    for (const std::string* s : {&info.name, &info.type, &info.grid_class, &info.note}) out.text(*s);
    out.value(info.active_samples);
    out.value(info.voxel_size);
  }
  const std::uint32_t warnings = out.count(file.warnings.size());
  for (std::uint32_t i = 0; i < warnings; ++i) out.text(file.warnings[i]);
  if (with_grid) send_grid(out, file.grid);
  out.close();
}

VdbFile receive_file(const ByteSource& read, const std::string& path, std::uint64_t max_bytes,
                     bool with_grid) {
  StreamIn in(read, path, layout);
  VdbFile file;
  const std::uint32_t grids = in.count();
  for (std::uint32_t i = 0; i < grids; ++i) {
    VdbGridInfo info;
    for (std::string* s : {&info.name, &info.type, &info.grid_class, &info.note}) *s = in.text();
    info.active_samples = in.value<std::uint64_t>();
    info.voxel_size = in.value<double>();
    file.grids.push_back(std::move(info));
  }
  const std::uint32_t warnings = in.count();
  for (std::uint32_t i = 0; i < warnings; ++i) file.warnings.push_back(in.text());
  if (with_grid) file.grid = receive_grid(in, max_bytes);
  in.close();
  return file;
}

} // namespace levelray
