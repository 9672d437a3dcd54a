#include "levelray/measure/extremes.hpp"
namespace levelray {
std::vector<ExtremeRow> extreme_mesh_rows() { return {}; }
}
