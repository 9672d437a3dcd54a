#include "starting_scene.hpp"

#include <cctype>
#include <filesystem>

namespace levelray {

namespace {

namespace fs = std::filesystem;

// As seen from the scene's folder; absolute paths stay.
std::string from_scene(const std::string& scene, const std::string& path) {
  if (fs::path(path).is_absolute()) return path;
  std::error_code ignored;
  const fs::path folder = fs::absolute(scene, ignored).parent_path();
  const fs::path relative =
      fs::absolute(path, ignored).lexically_normal().lexically_relative(folder.lexically_normal());
  return relative.empty() ? fs::absolute(path, ignored).string() : relative.string();
}

// "cache/liquid.####.vdb": liquid.
std::string name_of(const std::string& path) {
  std::string name;
  for (const char c : fs::path(path).stem().string()) {
    if (c == '#' || c == '%' || c == '{') break;
    const bool letter = std::isalpha(static_cast<unsigned char>(c)) || c == '_';
    if (letter || (!name.empty() && std::isdigit(static_cast<unsigned char>(c))))
      name += c;
    else if (!name.empty())
      name += '_';
  }
  while (!name.empty() && name.back() == '_') name.pop_back();
  return name.empty() ? "object" : name;
}

MaterialFile material_file(const Material& material) {
  MaterialFile file;
  file.kind = material.kind == MaterialKind::phong ? "phong" : "diffuse"; // what pictures of one grid have
  file.albedo = material.albedo;
  if (material.kind == MaterialKind::phong) file.specular = material.specular;
  file.exponent = material.exponent;
  return file;
}

} // namespace

SceneFile starting_scene(const std::string& path, const InputOptions& input,
                         const ConversionOptions& conversion, const std::string& frames,
                         const BlockGrid& grid, const RenderOptions& picture) {
  const Scene scene = one_grid_scene(grid, picture);
  SceneFile file;
  file.path = path;
  file.camera.eye = picture.camera.eye;
  file.camera.target = picture.camera.target;
  file.camera.up = picture.camera.up;
  file.camera.fov = picture.camera.fov_degrees;
  file.film.size = {picture.camera.width, picture.camera.height};
  file.film.samples = picture.samples;
  file.film.aov = picture.aovs;

  ObjectFile& object = file.objects.emplace_back();
  object.name = name_of(input.path);
  if (is_vdb(input.path)) {
    object.level_set = from_scene(path, input.path);
    object.grid = input.grid;
    object.redistance = conversion.redistance;
  } else {
    object.mesh = from_scene(path, input.path);
    ConvertFile& convert = object.convert.emplace();
    convert.resolution = conversion.resolution;
    if (!conversion.voxel.empty()) convert.voxel = conversion.voxel;
    convert.band = conversion.band;
    convert.sign = conversion.sign;
    if (!conversion.thicken.empty()) convert.thicken = conversion.thicken;
    if (!input.units.empty()) convert.units = input.units;
  }
  object.material = material_file(scene.instances.front().material);

  for (const DirectionalLight& light : scene.directional_lights) {
    LightFile& written = file.lights.emplace_back();
    written.direction = light.to_light;
    written.intensity = light.intensity;
    written.color = light.color;
    written.shadows = picture.shadows && light.casts_shadows;
  }
  file.ambient = scene.ambient;
  if (scene.ground) file.ground.emplace();
  file.render.intersector = picture.intersector;
  file.render.normals = picture.normals;
  if (!frames.empty()) file.frames = frames;
  file.outputs = {object.name + (frames.empty() ? ".exr" : ".####.exr")};
  return file;
}

} // namespace levelray
