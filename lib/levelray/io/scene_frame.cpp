#include "levelray/io/scene_frame.hpp"

#include "levelray/io/key_writer.hpp"
#include "levelray/io/scene_animation.hpp"
#include "levelray/io/scene_keys.hpp"

#include <limits>

namespace levelray {

namespace {

bool same_file(const SceneInput& a, const SceneInput& b) {
  return a.path == b.path && a.is_mesh == b.is_mesh && a.grid == b.grid && a.redistance == b.redistance &&
         to_json(a.convert) == to_json(b.convert);
}

Material material_of(const MaterialFile& file) {
  Material material;
  material.kind = file.kind == "phong"    ? MaterialKind::phong
                  : file.kind == "mirror" ? MaterialKind::mirror
                  : file.kind == "glass"  ? MaterialKind::glass
                                          : MaterialKind::diffuse;
  material.albedo = file.albedo;
  material.specular = file.specular.value_or(file.kind == "phong" ? shading_material("phong").specular : 0);
  material.exponent = file.exponent;
  material.ior = file.ior;
  material.tint = file.tint;
  return material;
}

Vec3d unit(const Vec3d& v) {
  // What is of unit length to the rounding of its own normalisation stays as it is, to the bit.
  const double length = v.length();
  return std::abs(length - 1) <= 4 * std::numeric_limits<double>::epsilon() ? v : v / length;
}

JsonValue vector_json(const Vec3d& v) {
  return JsonValue::array({v.x, v.y, v.z});
}

} // namespace

SceneInputs scene_inputs(const SceneFile& scene) {
  SceneInputs inputs;
  for (const ObjectFile& object : scene.objects) {
    SceneInput file;
    file.path = beside_scene(scene, object.path());
    file.is_mesh = object.mesh.has_value();
    file.grid = object.grid;
    file.redistance = object.redistance;
    if (object.convert) file.convert = *object.convert;
    file.place = object.place;
    std::size_t i = 0;
    while (i < inputs.files.size() && !same_file(inputs.files[i], file)) ++i;
    if (i == inputs.files.size()) inputs.files.push_back(file);
    inputs.of_object.push_back(i);
  }
  return inputs;
}

Scene scene_at(const SceneFile& file, const SceneInputs& inputs, double frame,
               std::span<const BlockGrid* const> grids) {
  Scene scene;
  for (std::size_t i = 0; i < file.objects.size(); ++i) {
    const ObjectFile& object = file.objects[i];
    Instance& instance = scene.instances.emplace_back();
    instance.grid = grids[inputs.of_object[i]];
    instance.world_from_object = placement_at(object.transform, frame);
    instance.material = material_of(object.material);
    instance.id = static_cast<std::uint32_t>(object.id > 0 ? static_cast<std::size_t>(object.id) : i + 1);
    instance.casts_shadows = object.shadows;
  }
  for (const LightFile& light : file.lights)
    if (light.kind == "point")
      scene.point_lights.push_back({light.position, light.intensity, light.shadows, light.color});
    else
      scene.directional_lights.push_back(
          {unit(light.direction), light.intensity, light.shadows, light.color});
  scene.ambient = file.ambient;
  if (file.sky) scene.sky = {file.sky->radiance, file.sky->visible};
  if (file.ground) {
    GroundSettings& ground = scene.ground.emplace();
    ground.up = file.camera.up;
    ground.height = file.ground->height;
    ground.centre = file.ground->centre;
    ground.radius = file.ground->radius;
    ground.material = material_of(file.ground->material);
  }
  if (file.ambient_occlusion) {
    scene.ambient_occlusion.samples = file.ambient_occlusion->samples;
    if (file.ambient_occlusion->radius) scene.ambient_occlusion.radius = *file.ambient_occlusion->radius;
  }
  scene.max_depth = file.render.max_depth;
  return scene;
}

RenderOptions render_options_at(const SceneFile& scene, double frame) {
  RenderOptions options;
  options.camera = camera_at(scene, frame);
  options.samples = scene.film.samples;
  options.aovs = scene.film.aov;
  options.intersector = scene.render.intersector;
  options.normals = scene.render.normals;
  options.shadows = true;
  return options;
}

std::string frame_text(const SceneFile& scene, const SceneInputs& inputs, double frame) {
  JsonValue text = full_scene_json(scene);
  for (const char* key : {"$schema", "frames", "fps", "outputs", "limits"})
    std::erase_if(text.members, [&](const JsonMember& member) { return member.key == key; });
  const CameraSettings camera = camera_at(scene, frame);
  text.set("camera", JsonValue::object({{"eye", vector_json(camera.eye), 0},
                                        {"target", vector_json(camera.target), 0},
                                        {"up", vector_json(camera.up), 0},
                                        {"fov", camera.fov_degrees, 0},
                                        {"ground_up", vector_json(scene.camera.up), 0}}));
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    JsonValue& object = text.find("objects")->items[i];
    for (const char* key : {"name", "level_set", "mesh"})
      std::erase_if(object.members, [&](const JsonMember& member) { return member.key == key; });
    object.set("file", static_cast<double>(inputs.of_object[i]));
    const Similarity placement = placement_at(scene.objects[i].transform, frame);
    object.set("transform", JsonValue::array({vector_json(placement.x_axis), vector_json(placement.y_axis),
                                              vector_json(placement.z_axis),
                                              vector_json(placement.translation), placement.scale}));
  }
  return compact_json_text(text);
}

} // namespace levelray
