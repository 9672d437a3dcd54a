// The large boxes of Occluders.
#include "levelray/accel/occluders.hpp"

#include <algorithm>

namespace levelray {

namespace {

// Cells of a coarse grid: blocks, or nodes where there are many.
struct Coarse {
  int dims[3];
  std::vector<std::uint8_t> inside;

  std::size_t at(int x, int y, int z) const {
    return static_cast<std::size_t>(x) +
           static_cast<std::size_t>(dims[0]) *
               (static_cast<std::size_t>(y) +
                static_cast<std::size_t>(dims[1]) * static_cast<std::size_t>(z));
  }
};

// The largest cube of inside cells that ends with each cell, by the maximal-square recurrence; returns the
// cell of the largest of all, the first of several, and its edge.
int largest_cube(const Coarse& grid, std::vector<std::uint8_t>& edge, int (&last)[3]) {
  int largest = 0;
  for (int z = 0; z < grid.dims[2]; ++z)
    for (int y = 0; y < grid.dims[1]; ++y)
      for (int x = 0; x < grid.dims[0]; ++x) {
        const std::size_t at = grid.at(x, y, z);
        if (!grid.inside[at]) {
          edge[at] = 0;
          continue;
        }
        int least = 254;
        for (int c = 1; c < 8; ++c) {
          const int i = x - (c & 1), j = y - (c >> 1 & 1), k = z - (c >> 2);
          least = std::min<int>(least, i < 0 || j < 0 || k < 0 ? 0 : edge[grid.at(i, j, k)]);
        }
        edge[at] = static_cast<std::uint8_t>(least + 1);
        if (least + 1 > largest) {
          largest = least + 1;
          last[0] = x, last[1] = y, last[2] = z;
        }
      }
  return largest;
}

bool all_inside(const Coarse& grid, const Occluders::Box& box) {
  for (int z = box.low[2]; z < box.end[2]; ++z)
    for (int y = box.low[1]; y < box.end[1]; ++y)
      for (int x = box.low[0]; x < box.end[0]; ++x)
        if (!grid.inside[grid.at(x, y, z)]) return false;
  return true;
}

// Moves the box's faces outwards in turn, as long as what they pass is inside.
void grow(const Coarse& grid, Occluders::Box& box) {
  for (bool grown = true; grown;) {
    grown = false;
    for (int a = 0; a < 3; ++a)
      for (const bool up : {false, true}) {
        Occluders::Box slice = box;
        if (up)
          slice.low[a] = box.end[a], slice.end[a] = box.end[a] + 1;
        else
          slice.low[a] = box.low[a] - 1, slice.end[a] = box.low[a];
        if (slice.low[a] < 0 || slice.end[a] > grid.dims[a] || !all_inside(grid, slice)) continue;
        (up ? box.end[a] : box.low[a]) += up ? 1 : -1;
        grown = true;
      }
  }
}

} // namespace

void Occluders::find_boxes(const SurfaceBlocks& surface) {
  const Vec3i dims = surface.node_dims();
  // 2^18 cells take about a millisecond per box.
  const bool by_blocks = inside_.size() * 64 <= std::size_t{1} << 18;
  const int per_node = by_blocks ? 4 : 1;
  Coarse grid{{dims.x * per_node, dims.y * per_node, dims.z * per_node}, {}};
  if (!by_blocks && inside_.size() > std::size_t{1} << 18) return; // none, rather than a long wait
  grid.inside.resize(inside_.size() * (by_blocks ? 64 : 1));
  std::size_t entry = 0;
  for (int z = 0; z < dims.z; ++z)
    for (int y = 0; y < dims.y; ++y)
      for (int x = 0; x < dims.x; ++x, ++entry) {
        if (!by_blocks) {
          grid.inside[grid.at(x, y, z)] = ~inside_[entry] == 0;
          continue;
        }
        for (int bit = 0; bit < 64; ++bit)
          grid.inside[grid.at(4 * x + bit_x(bit), 4 * y + bit_y(bit), 4 * z + bit_z(bit))] =
              inside_[entry] >> bit & 1;
      }

  std::vector<std::uint8_t> edge(grid.inside.size());
  int first_edge = 0;
  while (boxes_.size() < most_boxes) {
    int last[3] = {0, 0, 0};
    const int length = largest_cube(grid, edge, last);
    if (boxes_.empty()) first_edge = length;
    if (length == 0 || 4 * length < first_edge) break; // too small to be met often
    Box box;
    for (int a = 0; a < 3; ++a) box.low[a] = last[a] + 1 - length, box.end[a] = last[a] + 1;
    grow(grid, box);
    for (int z = box.low[2]; z < box.end[2]; ++z)
      for (int y = box.low[1]; y < box.end[1]; ++y)
        for (int x = box.low[0]; x < box.end[0]; ++x) grid.inside[grid.at(x, y, z)] = 0;
    for (int a = 0; a < 3; ++a) box.low[a] *= 4 / per_node, box.end[a] *= 4 / per_node;
    boxes_.push_back(box);
  }
}

} // namespace levelray
