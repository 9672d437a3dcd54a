#include "levelray/normal/neighbourhood.hpp"

namespace levelray {

Neighbourhood fetch_neighbourhood(const BlockGrid& grid, const Vec3i& cell) {
  Neighbourhood result;

  // Along each axis the samples cell-1 .. cell+2 are one run in one block, or two runs in two.
  int first[3], split[3]; // first sample; length of the first run
  for (int a = 0; a < 3; ++a) {
    first[a] = cell[a] - 1;
    split[a] = block_dim - (first[a] & (block_dim - 1));
  }
  for (int z = 0, z_end; z < 4; z = z_end) {
    z_end = z == 0 ? split[2] : 4;
    for (int y = 0, y_end; y < 4; y = y_end) {
      y_end = y == 0 ? split[1] : 4;
      for (int x = 0, x_end; x < 4; x = x_end) {
        x_end = x == 0 ? split[0] : 4;
        bool inside = false;
        const float* const block = grid.find_block(first[0] + x, first[1] + y, first[2] + z, &inside);
        const float constant = inside ? -grid.background : grid.background;
        for (int k = z; k < z_end; ++k)
          for (int j = y; j < y_end; ++j)
            for (int i = x; i < x_end; ++i)
              result.values[i + 4 * j + 16 * k] =
                  block ? block[bit_in_block(first[0] + i, first[1] + j, first[2] + k)] : constant;
      }
    }
  }
  return result;
}

} // namespace levelray
