// BlockGrid to openvdb::FloatGrid, for files and for comparisons with OpenVDB's own tools.
#pragma once

#include "levelray/grid/block_grid.hpp"

#include <openvdb/openvdb.h>

namespace levelray {

// A level set with the same value at every sample, the same active mask, the same background and transform,
// and the grid's name. Regions without samples are inactive tiles of +-background at the highest level of the
// tree that holds them whole. OpenVDB must be initialised. Throws Error(limit) for a voxel size that
// OpenVDB's maps refuse.
openvdb::FloatGrid::Ptr to_openvdb(const BlockGrid& grid);

// Registers OpenVDB's types, once.
void initialize_openvdb();

} // namespace levelray
