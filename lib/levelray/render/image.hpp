// A picture of named float channels.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace levelray {

// Channels hold width * height values, rows from the top, scene-linear. R, G, B are premultiplied by the
// coverage A in [0,1].
struct Image {
  struct Channel {
    std::string name;
    std::vector<float> values;
  };

  int width = 0, height = 0; // pixels
  std::vector<Channel> channels;

  std::size_t pixel_count() const {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  }

  // The channel's values, or null when there is none of that name.
  const std::vector<float>* find(std::string_view name) const {
    for (const Channel& channel : channels)
      if (channel.name == name) return &channel.values;
    return nullptr;
  }
  // Appends a channel of zeros. The reference is valid until the next one is added.
  std::vector<float>& add(std::string name) {
    channels.push_back({std::move(name), std::vector<float>(pixel_count(), 0.0f)});
    return channels.back().values;
  }
};

} // namespace levelray
