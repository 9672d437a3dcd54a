#include "levelray/convert/field_to_grid.hpp"

#include "levelray/core/error.hpp"
#include "levelray/grid/complete_blocks.hpp"

#include <algorithm>

namespace levelray {

FieldBand::FieldBand(const FieldSampling& sampling, const Box3d& box) : max_bytes_(sampling.max_bytes) {
  if (!(sampling.voxel_size > 0) || !(sampling.half_width_voxels >= 1) || box.isEmpty())
    throw Error(ErrorKind::usage, "a field needs voxels larger than 0, a band of 1 voxel or more, and a box");
  grid_.transform.origin = sampling.origin;
  grid_.transform.voxel_size = sampling.voxel_size;
  const double width = sampling.half_width_voxels * sampling.voxel_size;
  grid_.background = static_cast<float>(width);
  if (static_cast<double>(grid_.background) < width) // never less, as OpenVDB's check of level sets wants it
    grid_.background = std::nextafter(grid_.background, std::numeric_limits<float>::infinity());

  // The band reaches half a width beyond the box; one more sample, so that what is not outside has a margin.
  const double margin = sampling.half_width_voxels + 2;
  double entries = 1;
  for (int a = 0; a < 3; ++a) {
    const double low = (box.min[a] - sampling.origin[a]) / sampling.voxel_size - margin;
    const double high = (box.max[a] - sampling.origin[a]) / sampling.voxel_size + margin;
    if (!(low > -0x1p30 && high < 0x1p30))
      throw Error(ErrorKind::limit, "a field's samples have indices beyond 2^30; try larger voxels");
    grid_.node_min[a] = static_cast<int>(std::floor(low)) >> 4;
    grid_.node_dims[a] = (static_cast<int>(std::ceil(high)) >> 4) - grid_.node_min[a] + 1;
    entries *= grid_.node_dims[a];
  }
  if (entries * static_cast<double>(sizeof(Node) + sizeof(std::uint32_t)) > static_cast<double>(max_bytes_))
    throw Error(ErrorKind::limit,
                "a field's table of nodes needs more memory than allowed; try larger voxels");
  nodes_.resize(static_cast<std::size_t>(entries));
}

Vec3i FieldBand::node_coord(std::size_t entry) const {
  const std::size_t x = static_cast<std::size_t>(grid_.node_dims.x),
                    y = static_cast<std::size_t>(grid_.node_dims.y);
  return grid_.node_min +
         Vec3i(static_cast<int>(entry % x), static_cast<int>(entry / x % y), static_cast<int>(entry / x / y));
}

void FieldBand::set_samples(std::size_t entry, const float* values) {
  Node& node = nodes_[entry];
  const float background = grid_.background;
  for (int bit = 0; bit < 64; ++bit) {
    const int first = block_dim * (bit_x(bit) + node_dim * (bit_y(bit) + node_dim * bit_z(bit)));
    float block[samples_per_block];
    std::uint64_t active = 0;
    for (int s = 0; s < samples_per_block; ++s) {
      const float value = values[first + bit_x(s) + node_dim * (bit_y(s) + node_dim * bit_z(s))];
      block[s] = std::clamp(value, -background, background) + 0.0f; // -0 becomes +0
      active |= std::uint64_t{std::fabs(block[s]) < background} << s;
    }
    if (active) {
      node.stored |= std::uint64_t{1} << bit;
      node.values.insert(node.values.end(), block, block + samples_per_block);
      node.active.push_back(active);
    } else if (block[0] <
               0) { // neighbours differ by a voxel at most, so without a band there is one side only
      node.inside_blocks |= std::uint64_t{1} << bit;
    }
  }
}

BlockGrid FieldBand::finish() {
  std::size_t blocks = 0;
  for (const Node& node : nodes_) blocks += node.active.size();
  if (blocks * (samples_per_block * sizeof(float) + 2 * sizeof(std::uint64_t)) > max_bytes_)
    throw Error(ErrorKind::limit, "a field's band needs more memory than allowed; try larger voxels");
  grid_.values.reserve(blocks * samples_per_block);
  grid_.active.reserve(blocks);
  for (std::size_t entry = 0; entry < nodes_.size(); ++entry) {
    Node& node = nodes_[entry];
    if (!node.stored && (node.inside || !node.inside_blocks || node.inside_blocks == ~std::uint64_t{0})) {
      grid_.node_table.push_back(node.inside || node.inside_blocks ? BlockGrid::inside_node
                                                                   : BlockGrid::outside_node);
      continue;
    }
    grid_.node_table.push_back(static_cast<std::uint32_t>(grid_.nodes.size()));
    grid_.nodes.push_back({node_coord(entry), node.stored, node.inside_blocks, grid_.active.size()});
    grid_.values.insert(grid_.values.end(), node.values.begin(), node.values.end());
    grid_.active.insert(grid_.active.end(), node.active.begin(), node.active.end());
    node = Node();
  }
  nodes_.clear();
  complete_blocks(grid_, max_bytes_); // bands below sqrt(3) voxels leave out blocks that the surface crosses
  return std::move(grid_);
}

} // namespace levelray
