#include "levelray/normal/neighbourhood.hpp"

namespace levelray {

namespace {

// Blocks of a constant value, for where none is stored: rare so near the surface. One per side and thread is
// enough, as all neighbourhoods that a thread has at a time are of one grid.
const float* constant_block(bool inside, float background) {
  thread_local float blocks[2][samples_per_block];
  float(&block)[samples_per_block] = blocks[inside];
  for (float& value : block) value = inside ? -background : background;
  return block;
}

} // namespace

Neighbourhood::Neighbourhood(const BlockGrid& grid, const Vec3i& cell) {
  const Vec3i low = cell - Vec3i(1, 1, 1);
  crossed_ = 0;
  for (unsigned a = 0; a < 3; ++a) {
    first_[a] = static_cast<std::uint32_t>(low[static_cast<int>(a)]) & 3;
    crossed_ |= unsigned{first_[a] != 0} << a;
  }
  // All subsets of the crossed axes.
  unsigned b = 0;
  do {
    bool inside = false;
    const float* const block =
        grid.find_block(low.x + (b & 1 ? 3 : 0), low.y + (b & 2 ? 3 : 0), low.z + (b & 4 ? 3 : 0), &inside);
    blocks_[b] = block ? block : constant_block(inside, grid.background);
    b = (b - crossed_) & crossed_;
  } while (b);
}

} // namespace levelray
