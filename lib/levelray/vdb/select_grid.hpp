// Which grid of a file the user means.
#pragma once

#include "levelray/vdb/vdb_file.hpp"

#include <string>
#include <vector>

namespace levelray {

// The index of the grid that `wanted` names ("name", "name[i]", "[i]"), or with an empty `wanted` of the only
// level set, else of the only grid that may be one. Throws Error(bad_input) naming `path`, the reason, and
// the file's grids.
std::size_t select_grid(const std::vector<VdbGridInfo>& grids, const std::string& wanted,
                        const std::string& path);

// "density [fog volume], v [vec3s]": every grid with what it is, clamped.
std::string grid_list(const std::vector<VdbGridInfo>& grids);

} // namespace levelray
