// --tolerance of convert and render: voxel size, storage, intersector, normals and acceleration by the error
// that is allowed (measure/tolerance.hpp).
#pragma once

#include "input.hpp"
#include "levelray/measure/tolerance.hpp"
#include "render_options.hpp"

#include <optional>
#include <string>

namespace levelray {

// "0.05mm", "0.1vx", "0.25px": a length as options take them, or pixels.
struct Tolerance {
  std::string text; // as given
  double value = 0;
  bool pixels = false;
  Length length; // when it is none of pixels

  std::string unit() const; // "mm", "vx", "px", ...; "" for a plain number
};
// Throws Error(usage).
Tolerance parse_tolerance(const std::string& text);

struct ToleranceOption {
  std::string text; // empty: not asked for

  void add_to(CLI::App& command, bool pixels);
  bool asked() const { return !text.empty(); }
};

// Where the choice is not free: options that were given explicitly.
struct ToleranceLimits {
  bool voxel = false; // --voxel or --resolution
  std::string intersector, normals;
  std::optional<bool> half;
  bool stored = false;                     // the result is a file: convert
  double least_voxel = 0;                  // that it can hold
  const PictureOptions* picture = nullptr; // render's, which make pixels

  // Of what was given on the command line.
  static ToleranceLimits of_convert(const CLI::App& command, bool half);
  static ToleranceLimits of_render(const CLI::App& command, const PictureOptions& picture);
};

// A grid that meets the tolerance, and how.
struct TolerableGrid {
  LoadedGrid loaded;
  ToleranceResult chosen; // without its grid
  Json json;              // the `tolerance` of --json
};

// Converts a mesh to the tolerance, or finds how to trace and store a .vdb, and tells about it. Throws
// Error(limit) where memory, the format or explicit options forbid it and Error(bad_input) where the mesh
// does, naming the smallest tolerance that can be met.
TolerableGrid load_to_tolerance(const ToleranceOption& option, const ToleranceLimits& limits,
                                const InputOptions& input, const ConversionOptions& conversion,
                                const CommonOptions& common, Progress& progress);

} // namespace levelray
