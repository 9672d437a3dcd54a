// Images cut into square tiles, the unit of parallel work.
#pragma once

#include "levelray/core/parallel.hpp"

#include <algorithm>
#include <cstddef>

namespace levelray {

inline constexpr int tile_size = 32; // pixels along each side

struct Tile {
  int x_begin, y_begin, x_end, y_end; // pixels, ends excluded
};

// Calls body(tile) for the tiles that cover the image, on all allowed threads. The tiling depends on the size
// alone.
template <class Body>
void for_each_tile(int width, int height, Body&& body) {
  const std::size_t columns = static_cast<std::size_t>((width + tile_size - 1) / tile_size);
  const std::size_t rows = static_cast<std::size_t>((height + tile_size - 1) / tile_size);
  parallel_for(columns * rows, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const int x = static_cast<int>(i % columns) * tile_size, y = static_cast<int>(i / columns) * tile_size;
      body(Tile{x, y, std::min(x + tile_size, width), std::min(y + tile_size, height)});
    }
  });
}

} // namespace levelray
