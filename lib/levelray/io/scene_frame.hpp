// One frame of a scene file, ready to load and to render.
#pragma once

#include "levelray/io/scene_file.hpp"
#include "levelray/render/render_image.hpp"
#include "levelray/render/scene.hpp"

#include <span>

namespace levelray {

// A file that objects are read from, and how. Objects that say the same share one.
struct SceneInput {
  std::string path; // beside the scene; #### stands for the frame's number
  bool is_mesh = false;
  std::string grid, redistance; // of a level set
  ConvertFile convert;          // of a mesh
  std::string place;            // of the first object that says so
};

struct SceneInputs {
  std::vector<SceneInput> files;
  std::vector<std::size_t> of_object; // for each object, the index of its file
};
SceneInputs scene_inputs(const SceneFile& scene);

// The scene at a frame. grids[i] is what was read from the i-th file of `inputs`; not owned. Level sets are
// not set. Throws Error(usage) where the frame's values are no scene.
Scene scene_at(const SceneFile& scene, const SceneInputs& inputs, double frame,
               std::span<const BlockGrid* const> grids);

// Camera, film and methods at a frame; shadows are on, because each light says whether it casts any.
RenderOptions render_options_at(const SceneFile& scene, double frame);

// Everything that the file says about the picture of one frame, as one line of JSON: the same text means the
// same picture from the same content of the input files. Animation is resolved; names of files and of
// objects, lists of frames, outputs and limits are left out.
std::string frame_text(const SceneFile& scene, const SceneInputs& inputs, double frame);

} // namespace levelray
