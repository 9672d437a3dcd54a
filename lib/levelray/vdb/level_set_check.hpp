// What a user should know about a level set that somebody else made.
#pragma once

#include "levelray/convert/field_facts.hpp"
#include "levelray/grid/block_grid.hpp"

#include <string>
#include <vector>

namespace levelray {

// One-line remarks, with numbers, on a band that is too narrow to interpolate in, values beyond the
// background, and values that are no distances, by the grid's facts. Tracing is exact for the interpolated
// values in any case; sphere-like shortcuts and offsets are not.
std::vector<std::string> level_set_remarks(const BlockGrid& grid, const FieldFacts& facts);

} // namespace levelray
