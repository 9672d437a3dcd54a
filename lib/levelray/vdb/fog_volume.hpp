// Fog volumes as solids.
#pragma once

#include <openvdb/openvdb.h>

namespace levelray {

// Replaces every value v of the tree, active or not, leaf or tile, and the background by iso - v: negative
// where a density is above iso. Differences are rounded once, in the grid's own type.
template <class Grid>
void subtract_from_iso(Grid& grid, float iso);

extern template void subtract_from_iso(openvdb::FloatGrid&, float);
extern template void subtract_from_iso(openvdb::DoubleGrid&, float);

} // namespace levelray
