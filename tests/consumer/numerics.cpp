// The numerics of an installed levelray, linked without its file adapters.
#include <levelray/core/parallel.hpp>
#include <levelray/grid/block_grid.hpp>

#include <cstdio>

int main() {
  levelray::BlockGrid grid;
  grid.background = 3;
  levelray::update_cell_masks(grid);
  std::size_t chunks[4] = {};
  levelray::parallel_for(4, 1, [&](std::size_t begin, std::size_t) { chunks[begin] = 1; });
  const bool good = grid.value(0, 0, 0) == 3.0f && chunks[0] + chunks[1] + chunks[2] + chunks[3] == 4;
  std::puts(good ? "numerics: good" : "numerics: wrong");
  return good ? 0 : 1;
}
