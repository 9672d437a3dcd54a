#include "levelray/measure/thickness.hpp"

#include <algorithm>

namespace levelray {

namespace {

double quantile(const std::vector<double>& sorted, double q) {
  if (sorted.empty()) return 0;
  return sorted[std::min(sorted.size() - 1,
                         static_cast<std::size_t>(q * static_cast<double>(sorted.size())))];
}

} // namespace

Thickness thickness_statistics(std::vector<double> inward, std::vector<double> outward,
                               const std::vector<double>& voxel_sizes) {
  for (std::vector<double>* all : {&inward, &outward}) {
    std::erase_if(*all, [](double t) { return !(t > 0); });
    std::sort(all->begin(), all->end());
  }
  Thickness result;
  result.points = inward.size(), result.gaps = outward.size();
  result.p01 = quantile(inward, 0.001), result.p1 = quantile(inward, 0.01);
  result.p5 = quantile(inward, 0.05), result.p50 = quantile(inward, 0.5);
  result.gap_p1 = quantile(outward, 0.01), result.gap_p50 = quantile(outward, 0.5);
  for (const double h : voxel_sizes) {
    const auto thin = std::lower_bound(inward.begin(), inward.end(), 2 * h) - inward.begin();
    result.thin_share.push_back(static_cast<double>(thin) /
                                static_cast<double>(std::max<std::size_t>(1, inward.size())));
  }
  return result;
}

} // namespace levelray
