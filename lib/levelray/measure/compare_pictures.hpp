// How much two pictures differ, as OpenImageIO's `idiff` measures it.
#pragma once

#include "levelray/measure/picture.hpp"
#include "levelray/measure/thresholds.hpp"
#include "levelray/render/image.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace levelray {

// Of differences |a - b| over all values; those that are not finite count in `not_finite` and in `max` alone.
struct DifferenceStatistics {
  double mean = 0, rms = 0;
  double psnr = 0; // dB: 20 log10(m / rms), m the largest value of both, at least 1; infinite when rms is 0
  double max = 0;  // infinite when a value is NaN or infinite and the other is not the same
  int max_x = 0, max_y = 0; // the first pixel (rows from the top) with the largest difference
  std::uint64_t not_finite = 0;
};

struct PictureComparison {
  std::string mismatch; // why the pictures cannot be compared; empty: the rest holds
  PixelBox window;      // what was compared: the union of the data windows
  std::vector<std::pair<std::string, DifferenceStatistics>> channels;
  DifferenceStatistics all;            // over all channels
  std::string max_channel;             // of all.max
  ThresholdCount pixels{Thresholds()}; // a pixel differs by the largest difference of its channels
  std::vector<std::string> remarks;
};

struct PictureCompareOptions {
  Thresholds thresholds;
  bool nan_fail = false; // NaN differs from NaN
};

// Pictures with different display windows or channel names do not match, nor do those whose data windows lie
// so far apart that 16 times their pixels do not fill the box around both. Where only one has data, the other
// is 0 (as in idiff). NaN equals NaN unless told otherwise, an infinity equals itself.
PictureComparison compare_pictures(const Picture& a, const Picture& b,
                                   const PictureCompareOptions& options = {});

// a - b per channel over the compared window, whose upper left corner becomes pixel 0,0. Only of pictures
// that match.
Image signed_difference(const Picture& a, const Picture& b, const PictureComparison& comparison);

// Every pixel's largest difference in false colours, as R, G, B, A: black is no difference, grey (up to 0.2)
// one of at most `fail`, and from there red over orange and yellow to white on a logarithmic scale up to the
// largest finite difference; magenta is infinite.
Image difference_colours(const Picture& a, const Picture& b, const PictureComparison& comparison,
                         const PictureCompareOptions& options);

} // namespace levelray
