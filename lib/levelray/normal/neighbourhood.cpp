#include "levelray/normal/neighbourhood.hpp"

namespace levelray {

namespace {

// Blocks of a constant value, for where none is stored: rare so near the surface, and one per thread and
// side is enough, as a Neighbourhood is used up before the next is made.
const float* constant_block(bool inside, float background) {
  thread_local float blocks[2][samples_per_block];
  float(&block)[samples_per_block] = blocks[inside];
  for (float& value : block) value = inside ? -background : background;
  return block;
}

} // namespace

Neighbourhood::Neighbourhood(const BlockGrid& grid, const Vec3i& cell) {
  Vec3i first = cell - Vec3i(1, 1, 1), second = first;
  unsigned crossed = 0;
  for (int a = 0; a < 3; ++a) {
    for (int i = 0; i < 4; ++i) {
      const int sample = first[a] + i;
      const bool next = sample >> 2 != first[a] >> 2;
      steps_[static_cast<std::size_t>(a)][static_cast<std::size_t>(i)] = {
          std::uint32_t{next} << a, static_cast<std::uint32_t>((sample & 3) << 2 * a)};
    }
    second[a] = first[a] + 3;
    crossed |= unsigned{second[a] >> 2 != first[a] >> 2} << a;
  }
  for (unsigned b = 0; b < 8; ++b) {
    if (b & ~crossed) continue;
    bool inside = false;
    const float* const block = grid.find_block(b & 1 ? second.x : first.x, b & 2 ? second.y : first.y,
                                               b & 4 ? second.z : first.z, &inside);
    blocks_[b] = block ? block : constant_block(inside, grid.background);
  }
}

} // namespace levelray
