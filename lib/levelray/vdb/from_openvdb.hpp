// OpenVDB's trees to BlockGrid.
#pragma once

#include "levelray/grid/block_grid.hpp"

#include <cstdint>
#include <openvdb/openvdb.h>
#include <string>
#include <vector>

namespace levelray {

// The samples of a scalar grid as a BlockGrid with the given transform, `cells` not yet set. Every sample
// keeps its value (rounded to float; -0 becomes +0) with these exceptions, each told in `warnings`:
//   - inactive tiles become +-background by their sign (0 counts as outside);
//   - inactive samples of 0 become +background; other inactive samples that are not +-background become
//   active;
//   - when the background is 0, it becomes the largest |value|.
// Active tiles become blocks of active samples. Blocks are stored when they have an active sample or samples
// that differ; the others are counted inside or outside. `place` ("x.vdb: grid \"a\"") begins the errors:
// Error(bad_input) for values that are not finite, no active values, no surface (all values of one sign), a
// negative background; Error(limit) before allocation when indices leave +-2^30 or the result would exceed
// `max_bytes`.
template <class Grid>
BlockGrid from_openvdb(const Grid& grid, const GridTransform& transform, const std::string& place,
                       std::uint64_t max_bytes, std::vector<std::string>& warnings);

extern template BlockGrid from_openvdb(const openvdb::FloatGrid&, const GridTransform&, const std::string&,
                                       std::uint64_t, std::vector<std::string>&);
extern template BlockGrid from_openvdb(const openvdb::DoubleGrid&, const GridTransform&, const std::string&,
                                       std::uint64_t, std::vector<std::string>&);

} // namespace levelray
