// The options that spare rays work and change no picture.
#pragma once

#include "levelray/render/acceleration.hpp"
#include "options.hpp"

namespace levelray {

struct AccelerationOptions {
  std::string primary = "minmax", traversal = "leaps", shadow = "boxes";
  int minmax = 128, occluder_steps = 12;

  void add_to(CLI::App& command, const std::string& group);
  // Throws Error(usage) for unknown words.
  Acceleration resolve() const;
  Json json() const;
};

} // namespace levelray
