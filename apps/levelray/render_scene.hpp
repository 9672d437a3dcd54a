// levelray render, of a scene file.
#pragma once

#include "render_frames.hpp"

#include <vector>

namespace levelray {

// Renders the scene input.path, changed by `overrides` (--set) and by those options of `command` that a scene
// takes: film, methods, outputs, frames. Throws Error(usage) for options that a scene says itself, naming the
// key.
void render_scene(const CLI::App& command, const std::vector<std::string>& overrides,
                  const CommonOptions& common, const InputOptions& input, const PictureOptions& picture,
                  const RenderFramesOptions& frames);

} // namespace levelray
