#include "levelray/measure/compare_pictures.hpp"

#include "levelray/core/parallel.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace levelray {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// |a - b| >= 0; infinite for values that are not finite, unless they are the same.
double difference(double a, double b, bool nan_fail) {
  if (std::isfinite(a) && std::isfinite(b)) return std::fabs(a - b);
  if (std::isnan(a) && std::isnan(b)) return nan_fail ? infinity : 0;
  return a == b ? 0 : infinity;
}

std::string text_of(const PixelBox& box) {
  const std::string place =
      box.min.x == 0 && box.min.y == 0 ? "" : fmt::format(" at ({}, {})", box.min.x, box.min.y);
  return fmt::format("{} x {}{}", width_of(box), height_of(box), place);
}

bool holds(const PixelBox& box, int x, int y) {
  return x >= box.min.x && x <= box.max.x && y >= box.min.y && y <= box.max.y;
}

std::size_t index_in(const PixelBox& box, int x, int y) {
  return static_cast<std::size_t>(std::int64_t{y} - box.min.y) * static_cast<std::size_t>(width_of(box)) +
         static_cast<std::size_t>(std::int64_t{x} - box.min.x);
}

// A channel's value at a pixel; 0 where there is none.
double value_at(const Picture& picture, std::size_t channel, int x, int y) {
  return holds(picture.data_window, x, y)
             ? picture.channels[channel].value(index_in(picture.data_window, x, y))
             : 0;
}

std::string missing_channels(const Picture& of, const Picture& in) {
  std::string names;
  for (const Picture::Channel& channel : of.channels)
    if (std::none_of(in.channels.begin(), in.channels.end(),
                     [&](const Picture::Channel& other) { return other.name == channel.name; }))
      names += (names.empty() ? "" : ",") + channel.name;
  return names.empty() ? "none" : names;
}

std::string mismatch_of(const Picture& a, const Picture& b) {
  if (a.display_window != b.display_window)
    return fmt::format("different sizes: {} and {}", text_of(a.display_window), text_of(b.display_window));
  const bool same = std::equal(a.channels.begin(), a.channels.end(), b.channels.begin(), b.channels.end(),
                               [](const auto& l, const auto& r) { return l.name == r.name; });
  if (!same)
    return fmt::format("different channels: {} and {}; only in the first: {}; only in the second: {}",
                       a.channels.size(), b.channels.size(), missing_channels(a, b), missing_channels(b, a));
  const auto area = [](const PixelBox& box) {
    return static_cast<double>(width_of(box)) * static_cast<double>(height_of(box));
  };
  PixelBox both = a.data_window;
  both.extendBy(b.data_window);
  if (area(both) > 16 * (area(a.data_window) + area(b.data_window)))
    return fmt::format("data windows far apart: {} and {}", text_of(a.data_window), text_of(b.data_window));
  return "";
}

// Sums over rows first and rows then, which keeps rounding errors small.
struct Sums {
  double sum = 0, squares = 0;
  void add(const Sums& row) {
    sum += row.sum;
    squares += row.squares;
  }
};

void finish(DifferenceStatistics& s, const Sums& sums, double values, double largest) {
  s.mean = sums.sum / values;
  s.rms = std::sqrt(sums.squares / values);
  s.psnr = s.rms > 0 ? 20 * std::log10(largest / s.rms) : infinity;
}

// Calls visit(x, y, largest difference) for the pixels of one row of the window.
template <class Visit>
void visit_row(const Picture& a, const Picture& b, const PixelBox& window, int y, bool nan_fail,
               std::vector<double>& row, const Visit& per_value) {
  row.assign(static_cast<std::size_t>(width_of(window)), 0);
  for (std::size_t c = 0; c < a.channels.size(); ++c)
    for (int x = window.min.x;; ++x) {
      const double va = value_at(a, c, x, y), vb = value_at(b, c, x, y);
      const double d = difference(va, vb, nan_fail);
      double& pixel = row[static_cast<std::size_t>(std::int64_t{x} - window.min.x)];
      pixel = std::max(pixel, d);
      per_value(c, x, d, va, vb);
      if (x == window.max.x) break;
    }
}

Image image_of(const PixelBox& window) {
  Image image;
  image.width = static_cast<int>(width_of(window));
  image.height = static_cast<int>(height_of(window));
  return image;
}

} // namespace

PictureComparison compare_pictures(const Picture& a, const Picture& b, const PictureCompareOptions& options) {
  PictureComparison result;
  result.pixels = ThresholdCount(options.thresholds);
  result.mismatch = mismatch_of(a, b);
  if (!result.mismatch.empty()) return result;
  result.window = a.data_window;
  result.window.extendBy(b.data_window);
  if (a.data_window != b.data_window)
    result.remarks.push_back(fmt::format("different data windows: {} and {}; where only one has pixels, the "
                                         "other counts as 0",
                                         text_of(a.data_window), text_of(b.data_window)));

  const std::size_t channels = a.channels.size();
  std::vector<Sums> sums(channels), row_sums(channels);
  std::vector<double> largest(channels, 1), row;
  result.channels.resize(channels);
  for (std::size_t c = 0; c < channels; ++c) result.channels[c].first = a.channels[c].name;
  result.all.max = -1;
  for (int y = result.window.min.y;; ++y) {
    check_cancel();
    std::fill(row_sums.begin(), row_sums.end(), Sums());
    visit_row(a, b, result.window, y, options.nan_fail, row,
              [&](std::size_t c, int x, double d, double va, double vb) {
                DifferenceStatistics& s = result.channels[c].second;
                for (const double v : {va, vb})
                  if (std::isfinite(v)) largest[c] = std::max(largest[c], v);
                if (d > s.max) {
                  s.max = d;
                  s.max_x = x;
                  s.max_y = y;
                }
                if (std::isfinite(d)) {
                  row_sums[c].sum += d;
                  row_sums[c].squares += d * d;
                } else {
                  ++s.not_finite;
                }
              });
    for (std::size_t c = 0; c < channels; ++c) sums[c].add(row_sums[c]);
    for (const double d : row) result.pixels.add(d);
    if (y == result.window.max.y) break;
  }

  Sums total;
  double largest_of_all = 1, values = static_cast<double>(result.pixels.total());
  for (std::size_t c = 0; c < channels; ++c) {
    DifferenceStatistics& s = result.channels[c].second;
    finish(s, sums[c], std::max(values - static_cast<double>(s.not_finite), 1.0), largest[c]);
    total.add(sums[c]);
    largest_of_all = std::max(largest_of_all, largest[c]);
    result.all.not_finite += s.not_finite;
    if (s.max > result.all.max) {
      result.all.max = s.max;
      result.all.max_x = s.max_x;
      result.all.max_y = s.max_y;
      result.max_channel = result.channels[c].first;
    }
  }
  values = values * static_cast<double>(channels) - static_cast<double>(result.all.not_finite);
  finish(result.all, total, std::max(values, 1.0), largest_of_all);
  return result;
}

Image signed_difference(const Picture& a, const Picture& b, const PictureComparison& comparison) {
  const PixelBox& window = comparison.window;
  Image image = image_of(window);
  for (std::size_t c = 0; c < a.channels.size(); ++c) {
    std::vector<float>& values = image.add(a.channels[c].name);
    for (std::size_t i = 0; i < values.size(); ++i) {
      const std::size_t width = static_cast<std::size_t>(image.width);
      const int x = window.min.x + static_cast<int>(i % width),
                y = window.min.y + static_cast<int>(i / width);
      values[i] = static_cast<float>(value_at(a, c, x, y) - value_at(b, c, x, y));
    }
  }
  return image;
}

Image difference_colours(const Picture& a, const Picture& b, const PictureComparison& comparison,
                         const PictureCompareOptions& options) {
  const PixelBox& window = comparison.window;
  Image image = image_of(window);
  for (const char* name : {"R", "G", "B", "A"}) image.add(name);
  const auto channel = [&](std::size_t c, std::size_t i) -> float& { return image.channels[c].values[i]; };
  std::vector<double> differences(image.pixel_count()), row;
  double largest = 0;
  for (int y = 0; y < image.height; ++y) {
    visit_row(a, b, window, window.min.y + y, options.nan_fail, row, [](auto&&...) {});
    for (int x = 0; x < image.width; ++x) {
      const double d = row[static_cast<std::size_t>(x)];
      differences[static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                  static_cast<std::size_t>(x)] = d;
      if (std::isfinite(d)) largest = std::max(largest, d);
    }
  }
  const double fail = options.thresholds.fail;
  for (std::size_t i = 0; i < differences.size(); ++i) {
    const double d = differences[i];
    channel(3, i) = 1;
    if (!std::isfinite(d)) {
      channel(0, i) = channel(2, i) = 1;
    } else if (!(d > fail)) {
      const float grey = fail > 0 ? static_cast<float>(0.2 * d / fail) : 0;
      for (std::size_t c = 0; c < 3; ++c) channel(c, i) = grey;
    } else {
      // At least a factor of 10 between red and white; a threshold of 0 has no logarithm.
      const double low = std::max(fail, largest * 1e-6), high = std::max(largest, 10 * low);
      const double s = 3 * std::clamp(std::log(d / low) / std::log(high / low), 0.0, 1.0);
      channel(0, i) = static_cast<float>(std::clamp(0.5 + s, 0.0, 1.0));
      channel(1, i) = static_cast<float>(std::clamp(s - 1, 0.0, 1.0));
      channel(2, i) = static_cast<float>(std::clamp(s - 2, 0.0, 1.0));
    }
  }
  return image;
}

} // namespace levelray
