#include "levelray/measure/extremes.hpp"
namespace levelray {
std::vector<ExtremeRow> extreme_invariant_rows() { return {}; }
}
