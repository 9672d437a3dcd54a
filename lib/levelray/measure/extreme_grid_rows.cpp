#include "levelray/measure/extremes.hpp"
namespace levelray {
std::vector<ExtremeRow> extreme_grid_rows() { return {}; }
}
