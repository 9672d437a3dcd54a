#include "levelray/render/false_colour.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

namespace levelray {

namespace {

// IEC 61966-2-1:1999.
double from_srgb(double v) {
  return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

} // namespace

Vec3f false_colour(double fraction) {
  const double f = fraction > 0 ? std::min(fraction, 1.0) : 0;
  const double angle = 2 * std::numbers::pi * (0.5 / 3 + 1 - 1.5 * f), amplitude = f * (1 - f) / 2;
  const double c = std::cos(angle) * amplitude, s = std::sin(angle) * amplitude;
  const double display[3] = {f - 0.14861 * c + 1.78277 * s, f - 0.29227 * c - 0.90649 * s, f + 1.97294 * c};
  Vec3f colour;
  for (int i = 0; i < 3; ++i) colour[i] = static_cast<float>(from_srgb(std::clamp(display[i], 0.0, 1.0)));
  return colour;
}

float show_channel(Image& image, std::string_view name) {
  const std::vector<float>* const values = image.find(name);
  assert(values);
  const float top = values->empty() ? 0 : *std::max_element(values->begin(), values->end());
  std::vector<float> planes[3];
  for (auto& plane : planes) plane.resize(values->size());
  for (std::size_t i = 0; i < values->size(); ++i) {
    const Vec3f colour = false_colour(top > 0 ? static_cast<double>((*values)[i] / top) : 0);
    for (int c = 0; c < 3; ++c) planes[c][i] = colour[c];
  }
  for (Image::Channel& channel : image.channels) {
    for (int c = 0; c < 3; ++c)
      if (channel.name == std::string_view("RGB").substr(static_cast<std::size_t>(c), 1))
        channel.values = planes[c];
    if (channel.name == "A") std::fill(channel.values.begin(), channel.values.end(), 1.0f);
  }
  return top;
}

} // namespace levelray
