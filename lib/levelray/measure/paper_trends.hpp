// What the paper says of its Tables 1 to 4, and whether our figures say so too.
#pragma once

#include "levelray/measure/paper_suite.hpp"
#include "levelray/measure/printed_tables.hpp"

#include <string>
#include <vector>

namespace levelray {

struct PaperTrend {
  int table = 0;
  std::string claim, printed, ours; // the claim; the figures that say so, the paper's and ours
  std::string agrees;               // "yes", "no", or "in 25 of 27"
};

// The printed row that a row may be compared with: of a model that is the paper's, measured, in a picture of
// its size. Else null.
const PrintedRow* comparable(const PaperRow& row, int image_size);

// Of Tables 1 and 2, and of 3 and 4 over all rows that can be compared, if there are any. What needs times is
// left out where none were taken.
std::vector<PaperTrend> paper_trends(const PaperTorus& torus, const std::vector<PaperRow>& rows,
                                     int image_size);

} // namespace levelray
