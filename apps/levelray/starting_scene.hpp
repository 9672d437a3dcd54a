// A scene file that shows what `levelray render` shows of one input.
#pragma once

#include "levelray/io/scene_file.hpp"
#include "options.hpp"
#include "render_options.hpp"

namespace levelray {

// The scene of the picture that render_image(grid, picture) makes, its camera and lights written out; `path`
// is where it will be written. Paths in it are relative to its folder where the input's is relative.
SceneFile starting_scene(const std::string& path, const InputOptions& input,
                         const ConversionOptions& conversion, const std::string& frames,
                         const BlockGrid& grid, const RenderOptions& picture);

} // namespace levelray
