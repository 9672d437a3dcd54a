// Scene files: what a JSON scene says, as plain data. scene_keys.hpp lists its keys.
#pragma once

#include "levelray/core/vec.hpp"
#include "levelray/io/json_text.hpp"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace levelray {

// Members named `place` say where the file has it ("shot.json:7"), for messages; they are no keys.

struct CameraKey {
  double frame = 0;
  std::optional<Vec3d> eye, target, up; // world units
  std::optional<double> fov;            // degrees, vertical
  std::string place;
};

struct CameraFile {
  Vec3d eye{0, 0, 5}, target{0, 0, 0}, up{0, 1, 0};
  double fov = 45;
  std::string interpolation = "linear"; // or "smooth"
  std::vector<CameraKey> keys;          // by rising frame
  std::string place;
};

struct FilmFile {
  std::array<int, 2> size{512, 512}; // width and height, pixels
  int samples = 1;                   // per pixel, a square number
  std::vector<std::string> aov;
  std::string place;
};

struct RotationFile {
  Vec3d axis{0, 1, 0}; // of any length but 0
  double degrees = 0;  // right-handed
};

struct TransformKey {
  double frame = 0;
  std::optional<Vec3d> translate;
  std::optional<RotationFile> rotate;
  std::optional<double> scale;
  std::string place;
};

// World point = translate + rotate(scale * object point).
struct TransformFile {
  Vec3d translate{0, 0, 0};
  RotationFile rotate;
  double scale = 1;
  std::string interpolation = "linear"; // or "smooth"
  std::vector<TransformKey> keys;       // by rising frame
  std::string place;
};

// How a mesh becomes a grid; lengths and names as the options of the same names take them.
struct ConvertFile {
  int resolution = 256;
  std::optional<std::string> voxel; // instead of resolution
  std::string band = "3vx", sign = "auto";
  std::optional<std::string> units, thicken;
  std::string place;
};

// As Material (render/material.hpp), whose kind it names; so do the lights and surroundings below with
// theirs.
struct MaterialFile {
  std::string kind = "phong";
  Vec3d albedo{0.72, 0.72, 0.70};
  std::optional<double> specular; // nothing: 0.18 for phong, else 0
  double exponent = 32, ior = 1.5;
  Vec3d tint{1, 1, 1};
  std::string place;
};

// Of the ground, which has no inside: any kind but glass. By default diffuse, of the albedo of
// GroundSettings.
struct GroundMaterialFile : MaterialFile {
  GroundMaterialFile();
};

struct ObjectFile {
  std::string name;                           // unique, or empty
  int id = 0;                                 // of the id channel; 0: its place in the list, from 1
  std::optional<std::string> level_set, mesh; // one of them: a path, relative to the scene file's folder
  std::string grid;                           // of a .vdb with several
  std::string redistance = "auto";            // of a .vdb: "always", "never"
  std::optional<ConvertFile> convert;         // of a mesh; always there once a scene was read
  TransformFile transform;
  MaterialFile material;
  bool shadows = true; // casts some
  std::string place;

  const std::string& path() const { return level_set ? *level_set : *mesh; }
};

struct LightFile {
  std::string kind = "directional";
  Vec3d direction{0, 0, 1}; // directional: from the scene towards the light, any length
  Vec3d position{0, 0, 0};  // point, world units
  Vec3d color{1, 1, 1};
  double intensity = 1;
  bool shadows = true;
  std::string place;
};

struct SkyFile {
  Vec3d radiance{1, 1, 1};
  bool visible = false;
  std::string place;
};

struct GroundFile {
  std::optional<double> height;
  std::optional<Vec3d> centre;
  std::optional<double> radius;
  GroundMaterialFile material;
  std::string place;
};

struct AmbientOcclusionFile {
  int samples = 16;
  std::optional<double> radius; // world units; nothing: any distance
  std::string place;
};

struct RenderFile {
  std::string intersector, normals; // defaults: those of RenderOptions
  int max_depth = 8;
  RenderFile();
};

struct LimitsFile {
  std::optional<std::string> memory;
  std::optional<double> frame_seconds;
  std::string place;
};

struct SceneFile {
  std::optional<std::string> schema; // of editors; ignored
  int version = 1;
  std::optional<std::string> frames; // "1001-1100"
  double fps = 24;
  CameraFile camera;
  FilmFile film;
  std::vector<ObjectFile> objects;
  std::vector<LightFile> lights;
  double ambient = 0;
  std::optional<SkyFile> sky;
  std::optional<GroundFile> ground;
  std::optional<AmbientOcclusionFile> ambient_occlusion;
  RenderFile render;
  std::vector<std::string> outputs; // paths, relative to the scene file's folder
  LimitsFile limits;

  std::string path, place; // of the file itself
};

// Reads a scene, after changing it as `overrides` say: each "path.to.key=VALUE", as --set takes it. A path's
// steps are keys, indices from 0, or names of objects ("objects.dragon.material.ior=1.3"); VALUE is JSON or,
// where it is none, a text. Throws Error(usage) "path:line: reason; hint" for what is no scene, "--set ...:
// reason; hint" for overrides, Error(bad_input) for files that cannot be read.
SceneFile read_scene(const std::string& path, const std::vector<std::string>& overrides = {});

// The same of a text; `path` stands for the file.
SceneFile parse_scene(const std::string& text, const std::string& path,
                      const std::vector<std::string>& overrides = {});

// Whether the path is meant to be a scene: it ends in .json, or its first byte that is no blank is a brace.
bool is_scene(const std::string& path);

// `path` of the scene file's folder when it is relative.
std::string beside_scene(const SceneFile& scene, const std::string& path);

// The scene as JSON: all keys, or those that differ from their defaults, that must be there, or that somebody
// who edits the scene looks for first.
JsonValue full_scene_json(const SceneFile& scene);
JsonValue short_scene_json(const SceneFile& scene);

// The JSON Schema of scenes, and the reference of its keys as a Markdown table.
std::string scene_schema_text();
std::string scene_keys_table();

} // namespace levelray
