#include "levelray/vdb/fog_volume.hpp"

namespace levelray {

template <class Grid>
void subtract_from_iso(Grid& grid, float iso) {
  using Value = typename Grid::ValueType;
  for (auto value = grid.beginValueAll(); value; ++value) value.setValue(static_cast<Value>(iso) - *value);
  grid.tree().root().setBackground(static_cast<Value>(iso) - grid.background(), /*updateChildNodes=*/false);
}

template void subtract_from_iso(openvdb::FloatGrid&, float);
template void subtract_from_iso(openvdb::DoubleGrid&, float);

} // namespace levelray
