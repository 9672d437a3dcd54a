// Rows of the suite `extremes` (measure/extremes.hpp) about .vdb files: group "files".
#pragma once

#include "levelray/measure/extremes.hpp"

namespace levelray {

std::vector<ExtremeRow> extreme_vdb_rows();

} // namespace levelray
