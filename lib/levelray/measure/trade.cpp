#include "levelray/measure/trade.hpp"

#include <algorithm>

namespace levelray {

void mark_front(std::vector<TradeRow>& rows) {
  for (TradeRow& a : rows)
    a.in_front = std::none_of(rows.begin(), rows.end(), [&](const TradeRow& b) {
      if (a.is_normals != b.is_normals) return false;
      const bool no_worse =
          b.error.mean <= a.error.mean && b.lost <= a.lost && b.ns <= a.ns && b.megabytes <= a.megabytes;
      const bool better =
          b.error.mean < a.error.mean || b.lost < a.lost || b.ns < a.ns || b.megabytes < a.megabytes;
      return no_worse && better;
    });
}

} // namespace levelray
