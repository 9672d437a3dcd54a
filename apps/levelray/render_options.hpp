// The options of `levelray render` that make the picture.
#pragma once

#include "acceleration_options.hpp"
#include "framing.hpp"
#include "input.hpp"
#include "levelray/render/render_image.hpp"

namespace levelray {

struct PictureOptions {
  std::vector<std::string> outputs, lights;
  std::string size = "512x512", eye, target, up = "0,1,0", intersector = RenderOptions().intersector,
              normals = RenderOptions().normals, shading = "phong", aovs;
  double fov = 45;
  bool shadows = false, ground = false;
  int samples = 1, repeat = 1;
  AccelerationOptions acceleration;
  std::string show; // a counter to show in false colours, or empty

  void add_to(CLI::App& command);
  // All but the outputs.
  void add_look_to(CLI::App& command);
  // Throws Error(usage) for everything that can be told without the grid.
  void check() const { resolve_without_grid(); }
  // All but the camera's place, and lights where none are given.
  RenderOptions resolve_without_grid() const;
  // With a camera: the given one, completed by one that sees all surfaces.
  RenderOptions resolve(const Framing& surfaces) const;
  RenderOptions resolve(const BlockGrid& grid) const; // of one surface
  // Whether that depends on surfaces.
  bool needs_framing() const { return eye.empty() || target.empty(); }
  // Every option in force.
  Json json(const RenderOptions& resolved, int threads) const;
};

} // namespace levelray
