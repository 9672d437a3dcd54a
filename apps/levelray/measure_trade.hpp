// The trade's tables and plots, and thickness, as parts of a document of measurements.
#pragma once

#include "levelray/measure/thickness.hpp"
#include "levelray/measure/trade.hpp"
#include "options.hpp"

#include <string>
#include <vector>

namespace levelray {

// What the errors of the two kinds of rows are, like "distances of hits from the mesh".
struct TradeWords {
  std::string hits, normals;
};

// The document's section of that name.
Json trade_section(const std::vector<TradeRow>& rows, const TradeWords& words);

Json thickness_json(const Thickness& thickness);

} // namespace levelray
