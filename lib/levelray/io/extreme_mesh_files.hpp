// Rows of the suite `extremes` (measure/extremes.hpp) about files of meshes: group "files".
#pragma once

#include "levelray/measure/extremes.hpp"

namespace levelray {

std::vector<ExtremeRow> extreme_mesh_file_rows();

} // namespace levelray
