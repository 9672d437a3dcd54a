// Scenes as the program takes them: changed by options, checked, loaded.
#pragma once

#include "input.hpp"
#include "levelray/io/scene_frame.hpp"

namespace levelray {

// How the i-th file of a scene is read: as the options say, and the scene's object. Throws Error(usage),
// naming the object's line, for lengths that are none.
InputOptions input_of(const SceneInput& file, const InputOptions& options);
ConversionOptions conversion_of(const SceneInput& file);

// Throws Error(usage) for what only the program can tell of a scene: lengths, sizes, lists of frames.
void check_scene_file(const SceneFile& scene);

} // namespace levelray
