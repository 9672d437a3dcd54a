#include "levelray/io/scene_file.hpp"

#include "levelray/core/error.hpp"
#include "levelray/io/input_file.hpp"
#include "levelray/io/key_reader.hpp"
#include "levelray/io/key_schema.hpp"
#include "levelray/io/scene_keys.hpp"
#include "levelray/io/scene_override.hpp"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>

namespace levelray {

namespace fs = std::filesystem;

namespace {

// What the rules of single objects cannot say.
void check_names(const std::string& file, const JsonValue& root, const SceneFile& scene) {
  const std::vector<JsonValue>& values = root.find("objects")->items;
  for (std::size_t i = 0; i < scene.objects.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (const std::string& name = scene.objects[i].name; !name.empty() && name == scene.objects[j].name)
        refuse_value(file, *values[i].find("name"), fmt::format("objects[{}].name", i),
                     fmt::format("\"{}\" is the name of objects[{}] already", printable(name, 60), j));
}

// Drops the members that `standard` has with the same value; `must` are kept.
void drop_defaults(JsonValue& value, const JsonValue& standard, const std::vector<std::string>& must) {
  auto& members = value.members;
  for (JsonMember& member : members)
    if (const JsonValue* other = standard.find(member.key);
        other && member.value.kind == JsonValue::Kind::object)
      drop_defaults(member.value, *other, must);
  members.erase(std::remove_if(members.begin(), members.end(),
                               [&](const JsonMember& member) {
                                 if (std::find(must.begin(), must.end(), member.key) != must.end())
                                   return false;
                                 const JsonValue* other = standard.find(member.key);
                                 return (other && *other == member.value) ||
                                        (member.value.kind == JsonValue::Kind::object &&
                                         member.value.members.empty());
                               }),
                members.end());
}

} // namespace

RenderFile::RenderFile() : intersector(RenderOptions().intersector), normals(RenderOptions().normals) {}

GroundMaterialFile::GroundMaterialFile() {
  kind = "diffuse";
  albedo = GroundSettings().material.albedo;
}

SceneFile parse_scene(const std::string& text, const std::string& path,
                      const std::vector<std::string>& overrides) {
  const std::string file = printable(path, 200);
  JsonValue root = parse_json(text, file);
  if (root.kind != JsonValue::Kind::object)
    refuse_value(file, root, "", fmt::format("a scene is an object in braces, not {}", kind_text(root.kind)));
  for (const std::string& change : overrides) override_value(root, change);

  SceneFile scene;
  KeyReader reader(file, root, "");
  describe(reader, scene);
  reader.finish();
  scene.path = path;
  scene.place = file;
  check_names(file, root, scene);
  // Said or not, a mesh is converted somehow: what means the same is the same.
  for (ObjectFile& object : scene.objects)
    if (object.mesh && !object.convert) object.convert.emplace();
  return scene;
}

SceneFile read_scene(const std::string& path, const std::vector<std::string>& overrides) {
  const auto bytes = read_input(path, max_json_bytes);
  return parse_scene(std::string(bytes.data(), bytes.size()), path, overrides);
}

bool is_scene(const std::string& path) {
  if (path.size() >= 5 && path.substr(path.size() - 5) == ".json") return true;
  std::error_code ignored;
  if (!fs::is_regular_file(path, ignored)) return false;
  std::ifstream file(path, std::ios::binary);
  char first = 0;
  return file >> first && first == '{'; // >> skips blanks; no mesh or .vdb begins with a brace
}

std::string beside_scene(const SceneFile& scene, const std::string& path) {
  if (fs::path(path).is_absolute()) return path;
  return (fs::path(scene.path).parent_path() / path).string();
}

JsonValue full_scene_json(const SceneFile& scene) {
  return to_json(scene);
}

JsonValue short_scene_json(const SceneFile& scene) {
  JsonValue json = to_json(scene);
  drop_defaults(json, to_json(SceneFile()),
                {"levelray", "camera", "objects", "eye", "target", "fov", "film", "size", "samples"});
  if (JsonValue* objects = json.find("objects"))
    for (JsonValue& object : objects->items) {
      ObjectFile standard;
      standard.convert.emplace();
      drop_defaults(object, to_json(standard),
                    {"material", "kind", "albedo", "degrees", "level_set", "mesh"});
    }
  if (JsonValue* lights = json.find("lights"))
    for (JsonValue& light : lights->items)
      drop_defaults(light, to_json(LightFile()), {"kind", "direction", "position"});
  return json;
}

std::string scene_schema_text() {
  JsonValue schema = JsonValue::object(
      {{"$schema", "http://json-schema.org/draft-07/schema#", 0}, {"title", "levelray scene", 0}});
  JsonValue keys = schema_of(static_cast<const SceneFile*>(nullptr), Rule());
  for (JsonMember& member : keys.members) schema.members.push_back(std::move(member));
  return json_text(schema) + "\n";
}

std::string scene_keys_table() {
  std::vector<KeyTable::Row> rows;
  KeyTable::add<SceneFile>(rows, "");
  return KeyTable::text(rows);
}

} // namespace levelray
