// The keys of scene files, said once: the reader, the writer, the JSON Schema and the reference table come
// from here (key_rule.hpp).
#pragma once

#include "levelray/convert/mesh_to_grid.hpp"
#include "levelray/core/methods.hpp"
#include "levelray/intersect/intersectors.hpp"
#include "levelray/io/key_rule.hpp"
#include "levelray/io/scene_file.hpp"
#include "levelray/normal/normals.hpp"
#include "levelray/render/render_image.hpp"
#include "levelray/render/scene.hpp"

#include <cmath>

namespace levelray {

inline const std::vector<std::string>& interpolation_names() {
  static const std::vector<std::string> names{"linear", "smooth"};
  return names;
}
inline const std::vector<std::string>& material_kinds() {
  static const std::vector<std::string> names{"diffuse", "phong", "mirror", "glass"};
  return names;
}
inline const std::vector<std::string>& light_kinds() {
  static const std::vector<std::string> names{"directional", "point"};
  return names;
}
inline const std::vector<std::string>& redistance_names() {
  static const std::vector<std::string> names{"auto", "always", "never"};
  return names;
}
inline const std::vector<std::string>& unit_names() {
  static const std::vector<std::string> names{"mm", "cm", "m", "in"};
  return names;
}
// Lengths as apps/levelray/lengths.hpp takes them.
inline Rule length_text(bool voxels) {
  return voxels ? text_like("[0-9]*\\.?[0-9]+([eE][-+]?[0-9]+)?(mm|cm|m|in|%|vx)?",
                            "a length such as \"2mm\", \"0.5%\" or \"3vx\"")
                : text_like("[0-9]*\\.?[0-9]+([eE][-+]?[0-9]+)?(mm|cm|m|in|%)?",
                            "a length such as \"2mm\", \"0.01\" or \"0.5%\"");
}

// Whether keys stand in the order of their frames, each frame once.
template <class Key>
bool frames_rise(const std::vector<Key>& keys) {
  for (std::size_t i = 1; i < keys.size(); ++i)
    if (!(keys[i - 1].frame < keys[i].frame)) return false;
  return true;
}
constexpr const char* frames_rise_text = "the keys' frames must rise";

inline bool has_direction(const Vec3d& v) {
  return v.length() > 0;
}

template <class Visitor>
void describe(Visitor& v, CameraKey& key) {
  v.key("frame", key.frame, any().must(), "When");
  v.key("eye", key.eye, any(), "As of the camera; only what changes is named");
  v.key("target", key.target, any(), "As of the camera");
  v.key("up", key.up, any(), "As of the camera");
  v.key("fov", key.fov, above(0, 179), "As of the camera");
}

template <class Visitor>
void describe(Visitor& v, CameraFile& camera) {
  v.key("eye", camera.eye, any().must(), "Where the camera stands");
  v.key("target", camera.target, any().must(), "What it looks at");
  v.key("up", camera.up, any(), "What is up in the picture");
  v.key("fov", camera.fov, above(0, 179), "Vertical field of view, degrees");
  v.key("interpolation", camera.interpolation, one_of_names(interpolation_names()),
        "Between keys: straight, or with continuous velocity and no overshoot");
  v.key("keys", camera.keys, any(),
        "What the camera does over time. Before the first and after the last key it rests");
  v.require(camera.eye != camera.target, "target", "is where the eye is; the camera looks nowhere");
  v.require(has_direction(camera.up), "up", "has no direction");
  v.require(frames_rise(camera.keys), "keys", frames_rise_text);
}

template <class Visitor>
void describe(Visitor& v, FilmFile& film) {
  v.key("size", film.size, within(1, 65536), "Width and height in pixels");
  v.key("samples", film.samples, within(1, 1024), "Rays per pixel, on a regular grid: 1, 4, 9, 16, ...");
  v.key("aov", film.aov, one_of_names(aov_names()), "More channels for .exr");
  const int side = static_cast<int>(std::lround(std::sqrt(film.samples)));
  v.require(side * side == film.samples, "samples", "must be a square number: 1, 4, 9, 16, 25, ... 1024");
}

template <class Visitor>
void describe(Visitor& v, RotationFile& rotation) {
  v.key("axis", rotation.axis, any(), "Axis through the object's origin, of any length");
  v.key("degrees", rotation.degrees, any().must(), "Angle, counter-clockwise as the axis points at you");
  v.require(has_direction(rotation.axis), "axis", "has no direction");
}

template <class Visitor>
void describe(Visitor& v, TransformKey& key) {
  v.key("frame", key.frame, any().must(), "When");
  v.key("translate", key.translate, any(), "As of the transform; only what changes is named");
  v.key("rotate", key.rotate, any(), "As of the transform");
  v.key("scale", key.scale, within(1e-6, 1e6), "As of the transform");
}

template <class Visitor>
void describe(Visitor& v, TransformFile& transform) {
  v.key("translate", transform.translate, any(), "Third: moved by this");
  v.key("rotate", transform.rotate, any(), "Second: turned around its origin");
  v.key("scale", transform.scale, within(1e-6, 1e6), "First: all directions by the same factor");
  v.key("interpolation", transform.interpolation, one_of_names(interpolation_names()),
        "Between keys: straight, or with continuous velocity and no overshoot. Around one axis the angle "
        "changes, "
        "any number of turns; between different axes the shortest way is taken");
  v.key("keys", transform.keys, any(),
        "What the object does over time. Before the first and after the last key it rests");
  v.require(frames_rise(transform.keys), "keys", frames_rise_text);
}

template <class Visitor>
void describe(Visitor& v, ConvertFile& convert) {
  v.key("resolution", convert.resolution, within(1, 1 << 20), "Voxels along the longest side");
  v.key("voxel", convert.voxel, length_text(false), "Voxel size, instead of resolution");
  v.key("band", convert.band, length_text(true), "Half-width of the narrow band");
  v.key("sign", convert.sign, one_of_names(sign_method_names()), "What is inside");
  v.key("thicken", convert.thicken, length_text(true),
        "Make a sheet of an open mesh: all points within this of it");
  v.key("units", convert.units, one_of_names(unit_names()), "What a coordinate of the mesh means");
}

template <class Visitor>
void describe_material(Visitor& v, MaterialFile& material, const std::vector<std::string>& kinds) {
  v.kind(material.kind, kinds, "What the surface does with light");
  const bool glass = material.kind == "glass", mirror = material.kind == "mirror";
  if (!glass && !mirror) v.key("albedo", material.albedo, within(0, 1), "Scene-linear red, green, blue");
  if (material.kind != "diffuse") {
    v.key("specular", material.specular, within(0, 100),
          "Strength of the lights' highlights; without it 0.18 for phong, else 0");
    v.key("exponent", material.exponent, within(1, 1e6), "Their width: larger is narrower");
  }
  if (glass)
    v.key("ior", material.ior, within(0.1, 10), "Index of refraction, relative to what is around it");
  if (mirror) v.key("tint", material.tint, within(0, 1), "The part that is reflected, per colour");
  if (glass)
    v.key("tint", material.tint, within(0, 1),
          "The part that one world unit of way inside lets through, per colour");
}

template <class Visitor>
void describe(Visitor& v, MaterialFile& material) {
  describe_material(v, material, material_kinds());
}

template <class Visitor>
void describe(Visitor& v, GroundMaterialFile& material) {
  static const std::vector<std::string> kinds{"diffuse", "phong", "mirror"};
  describe_material(v, material, kinds);
}

template <class Visitor>
void describe(Visitor& v, ObjectFile& object) {
  v.key("name", object.name, text_like("[A-Za-z_][A-Za-z0-9_-]*", "a name of letters, digits, _ and -"),
        "For --set and messages; unique");
  v.key("id", object.id, within(0, static_cast<double>(largest_id)),
        "In the id channel; 0: its place in the list, from 1");
  v.key("level_set", object.level_set, not_empty(), "A .vdb; #### stands for the frame's number");
  v.key("mesh", object.mesh, not_empty(), "A mesh to convert, instead; #### as well");
  v.key("grid", object.grid, any(), "Of a .vdb with several: NAME, NAME[i] or [i]");
  v.key("redistance", object.redistance, one_of_names(redistance_names()),
        "Of a .vdb: make distances of its values; auto: where they are none");
  v.key("convert", object.convert, any(), "How the mesh becomes a level set");
  v.key("transform", object.transform, any(), "From the file's space to the world");
  v.key("material", object.material, any(), "What the surface does with light");
  v.key("shadows", object.shadows, any(), "Whether it casts shadows");
  v.one_of({"level_set", "mesh"});
  v.require(object.grid.empty() || object.level_set, "grid", "is for level_set, not for mesh");
  v.require(object.redistance == "auto" || object.level_set, "redistance", "is for level_set, not for mesh");
  v.require(!object.convert || object.mesh, "convert", "is for mesh, not for level_set");
}

template <class Visitor>
void describe(Visitor& v, LightFile& light) {
  v.kind(light.kind, light_kinds(), "Distant, or at a point");
  if (light.kind == "point")
    v.key("position", light.position, any().must(), "Where it is, world units");
  else
    v.key("direction", light.direction, any().must(), "From the scene towards the light, of any length");
  v.key("color", light.color, at_least(0), "A factor: scene-linear red, green, blue");
  v.key("intensity", light.intensity, at_least(0),
        light.kind == "point" ? "Radiance of a white surface that faces it from a distance of 1"
                              : "Radiance of a white surface that faces it");
  v.key("shadows", light.shadows, any(), "Whether it casts shadows");
  v.require(light.kind == "point" || has_direction(light.direction), "direction", "has no direction");
}

template <class Visitor>
void describe(Visitor& v, SkyFile& sky) {
  v.key("radiance", sky.radiance, at_least(0), "The same from everywhere: scene-linear red, green, blue");
  v.key("visible", sky.visible, any(), "Whether it is the picture's background, too, instead of alpha 0");
}

template <class Visitor>
void describe(Visitor& v, GroundFile& ground) {
  v.key("height", ground.height, any(),
        "Along camera.up; without it, the objects' lowest point of each frame");
  v.key("centre", ground.centre, any(), "Where it is opaque; without it, below the objects");
  v.key("radius", ground.radius, above(0),
        "Opaque within 2 radii, gone at 6; without it, that of the objects");
  v.key("material", ground.material, any(), "What it does with light");
}

template <class Visitor>
void describe(Visitor& v, AmbientOcclusionFile& occlusion) {
  v.key("samples", occlusion.samples, within(1, 65536), "Rays per shaded point");
  v.key("radius", occlusion.radius, above(0), "How far they look, world units; without it, any distance");
}

template <class Visitor>
void describe(Visitor& v, RenderFile& render) {
  static const std::vector<std::string> intersectors = method_names<Intersectors>();
  static const std::vector<std::string> normals = method_names<NormalSchemes>();
  v.key("intersector", render.intersector, one_of_names(intersectors), "How rays meet a cell's surface");
  v.key("normals", render.normals, one_of_names(normals), "How normals are found");
  v.key("max_depth", render.max_depth, within(0, 64), "Reflections and refractions in a row");
}

template <class Visitor>
void describe(Visitor& v, LimitsFile& limits) {
  v.key("memory", limits.memory, text_like("[0-9]*\\.?[0-9]+([kKMGT]i?)?B?", "a size such as \"8GiB\""),
        "Frames that need more are refused; --max-memory");
  v.key("frame_seconds", limits.frame_seconds, above(0), "Frames that take longer are given up");
}

template <class Visitor>
void describe(Visitor& v, SceneFile& scene) {
  v.key("$schema", scene.schema, any(), "For editors; ignored");
  v.key("levelray", scene.version, within(1, 1).must(), "Version of the format: 1");
  v.key("frames", scene.frames, any(), "Which frames, e.g. \"1001-1100x2\"; -f");
  v.key("fps", scene.fps, above(0, 1000), "Frames per second of a movie");
  v.key("camera", scene.camera, any().must(), "The camera");
  v.key("film", scene.film, any(), "The picture");
  v.key("objects", scene.objects, not_empty().must(), "What is seen");
  v.key("lights", scene.lights, any(), "What shines on it");
  v.key("ambient", scene.ambient, at_least(0), "Like a white sky of that radiance that is never seen");
  v.key("sky", scene.sky, any(), "Light of the same colour from everywhere");
  v.key("ground", scene.ground, any(), "A plane that fades out around the objects");
  v.key("ambient_occlusion", scene.ambient_occlusion, any(),
        "Sky and ambient are darker where surfaces are near");
  v.key("render", scene.render, any(), "How it is computed");
  v.key("outputs", scene.outputs, any(), "Pictures to write, .exr or .png; -o");
  v.key("limits", scene.limits, any(), "What a frame may take");
}

} // namespace levelray
