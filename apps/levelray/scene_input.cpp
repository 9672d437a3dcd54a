#include "scene_input.hpp"

#include "levelray/core/error.hpp"
#include "levelray/io/frame_list.hpp"

namespace levelray {

InputOptions input_of(const SceneInput& file, const InputOptions& options) {
  InputOptions input = options;
  input.path = file.path;
  input.grid = file.grid;
  input.units = file.convert.units.value_or("");
  return input;
}

ConversionOptions conversion_of(const SceneInput& file) {
  ConversionOptions conversion;
  conversion.resolution = file.convert.resolution;
  conversion.voxel = file.convert.voxel.value_or("");
  conversion.band = file.convert.band;
  conversion.sign = file.convert.sign;
  conversion.redistance = file.redistance;
  conversion.thicken = file.convert.thicken.value_or("");
  return conversion;
}

void check_scene_file(const SceneFile& scene) {
  const auto at = [](const std::string& place, const auto& check) {
    try {
      check();
    } catch (const Error& error) {
      throw Error(error.kind(), place + ": " + error.what());
    }
  };
  for (const SceneInput& file : scene_inputs(scene).files)
    at(file.place, [&] { conversion_of(file).check(); });
  if (scene.frames) at(scene.place, [&] { parse_frames("frames", *scene.frames); });
  if (scene.limits.memory)
    at(scene.limits.place, [&] { parse_bytes("limits.memory", *scene.limits.memory); });
}

} // namespace levelray
