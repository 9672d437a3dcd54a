#include "levelray/measure/extremes.hpp"
namespace levelray {
std::vector<ExtremeRow> extreme_system_rows() { return {}; }
}
