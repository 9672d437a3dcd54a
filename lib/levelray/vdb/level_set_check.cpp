#include "levelray/vdb/level_set_check.hpp"

#include <fmt/format.h>

namespace levelray {

std::vector<std::string> level_set_remarks(const BlockGrid& grid, const FieldFacts& facts) {
  std::vector<std::string> remarks;
  // Interpolation reads the samples of cells that meet the surface, up to sqrt(3) voxels away; below 1.5
  // voxels (users of OpenVDB tools know this number) many of them are clamped.
  if (const double width = grid.half_width_voxels(); !(width >= 1.5))
    remarks.push_back(
        fmt::format("the narrow band is only {:.3g} voxels wide on each side; below 1.5 the surface is "
                    "distorted, 3 is usual",
                    width));
  if (facts.beyond)
    remarks.push_back(fmt::format("{} samples of the band lie beyond the background {:.6g}, up to {:.6g}",
                                  facts.beyond, grid.background, facts.largest_beyond));
  if (!facts.is_distance()) remarks.push_back(describe_field(facts) + "; they are traced as they are");
  return remarks;
}

} // namespace levelray
