// What a grid of an OpenVDB file is, and whether it can be traced, by its metadata alone.
#pragma once

#include "levelray/vdb/archive_reader.hpp"
#include "levelray/vdb/vdb_file.hpp"

namespace levelray {

// The note on fog volumes.
inline constexpr const char* fog_volume_note =
    "is a fog volume (density), not a level set; --iso 0.5 makes a solid of it";

// The line about a grid; texts from the file are cleaned and clamped. `note` is empty for scalar level sets
// with uniform voxels, and for scalar grids without a class, which may be level sets.
VdbGridInfo describe_grid(const ArchivedGrid& grid);

// The grid's transform. Throws Error(bad_input), beginning with `place`, when it is not a uniform positive
// scale and a translation.
GridTransform uniform_transform(const openvdb::math::Transform& transform, const std::string& place);

} // namespace levelray
