#include "levelray/measure/extremes.hpp"
namespace levelray {
std::vector<ExtremeRow> extreme_shape_rows() { return {}; }
}
