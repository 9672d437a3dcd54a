#include "levelray/io/scene_file.hpp"

#include "support/catch.hpp"

#include <cstdlib>
#include <fstream>
#include <iterator>

using namespace levelray;

namespace {

const std::string scene_text = R"({
  "$schema": "scene.schema.json",
  "levelray": 1,
  "frames": "1-10x3", "fps": 25,
  "camera": {
    "eye": [0, 1, 5], "target": [0, 0.5, 0], "up": [0, 0, 1], "fov": 30, "interpolation": "smooth",
    "keys": [{"frame": -1, "eye": [1, 2, 3]}, {"frame": 2.5, "fov": 60, "target": [0, 0, 1], "up": [1, 0, 0]}]
  },
  "film": {"size": [1920, 1080], "samples": 16, "aov": ["Z", "N"]},
  "objects": [
    {
      "name": "dragon", "id": 7, "level_set": "cache/dragon.####.vdb", "grid": "surface[1]",
      "transform": {
        "translate": [1, 2, 3], "rotate": {"axis": [0, 0, 2], "degrees": -90}, "scale": 0.5,
        "keys": [{"frame": 1, "rotate": {"degrees": 0}}, {"frame": 9, "scale": 2, "translate": [0, 0, 0]}]
      },
      "material": {"kind": "glass", "tint": [1, 0.9, 0.8], "ior": 1.33}
    },
    {"mesh": "floor.obj", "convert": {"voxel": "5mm", "band": "4vx", "sign": "winding", "units": "m", "thicken": "1vx"}}
  ],
  "lights": [
    {"kind": "directional", "direction": [0, 2, 0], "intensity": 2, "color": [1, 1, 0.5]},
    {"kind": "point", "position": [1, 1, 1], "shadows": false}
  ],
  "ambient": 0.06, "sky": {"radiance": [0.1, 0.2, 0.3], "visible": true},
  "ground": {"height": -1},
  "ambient_occlusion": {"samples": 64, "radius": 0.25},
  "render": {"intersector": "midpoint", "normals": "difference-of-interpolations", "max_depth": 3},
  "outputs": ["out/beauty.####.exr"],
  "limits": {"memory": "8GiB", "frame_seconds": 600}
})";

std::string content(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

} // namespace

TEST_CASE("every key of a scene arrives where it belongs") {
  const SceneFile scene = parse_scene(scene_text, "shots/shot.json");
  CHECK(scene.frames == "1-10x3");
  CHECK(scene.fps == 25);
  CHECK(scene.camera.up == Vec3d(0, 0, 1));
  CHECK(scene.camera.fov == 30);
  CHECK(scene.camera.interpolation == "smooth");
  REQUIRE(scene.camera.keys.size() == 2);
  CHECK(scene.camera.keys[0].frame == -1);
  CHECK(scene.camera.keys[0].eye == Vec3d(1, 2, 3));
  CHECK(!scene.camera.keys[0].fov);
  CHECK(scene.camera.keys[1].frame == 2.5);
  CHECK(scene.camera.keys[1].fov == 60);
  CHECK(scene.film.size == std::array<int, 2>{1920, 1080});
  CHECK(scene.film.samples == 16);
  CHECK(scene.film.aov == std::vector<std::string>{"Z", "N"});
  REQUIRE(scene.objects.size() == 2);
  const ObjectFile& dragon = scene.objects[0];
  CHECK(dragon.name == "dragon");
  CHECK(dragon.id == 7);
  CHECK(dragon.path() == "cache/dragon.####.vdb");
  CHECK(dragon.grid == "surface[1]");
  CHECK(dragon.transform.translate == Vec3d(1, 2, 3));
  CHECK(dragon.transform.rotate.axis == Vec3d(0, 0, 2));
  CHECK(dragon.transform.rotate.degrees == -90);
  CHECK(dragon.transform.scale == 0.5);
  REQUIRE(dragon.transform.keys.size() == 2);
  CHECK(dragon.transform.keys[1].scale == 2);
  CHECK(dragon.material.kind == "glass");
  CHECK(dragon.material.ior == 1.33);
  CHECK(dragon.place == "shots/shot.json:11");
  CHECK(scene.objects[1].convert->voxel == "5mm");
  CHECK(scene.objects[1].convert->sign == "winding");
  CHECK(scene.objects[1].convert->thicken == "1vx");
  CHECK(scene.objects[1].material.kind == "phong");
  CHECK(scene.lights[0].intensity == 2);
  CHECK(scene.lights[1].kind == "point");
  CHECK(!scene.lights[1].shadows);
  CHECK(scene.ambient == 0.06);
  CHECK(scene.sky->radiance == Vec3d(0.1, 0.2, 0.3));
  CHECK(scene.sky->visible);
  CHECK(scene.ground->height == -1);
  CHECK(scene.ground->material.kind == "diffuse");
  CHECK(scene.ambient_occlusion->samples == 64);
  CHECK(scene.ambient_occlusion->radius == 0.25);
  CHECK(scene.render.intersector == "midpoint");
  CHECK(scene.render.max_depth == 3);
  CHECK(scene.outputs == std::vector<std::string>{"out/beauty.####.exr"});
  CHECK(scene.limits.memory == "8GiB");
  CHECK(scene.limits.frame_seconds == 600);

  CHECK(beside_scene(scene, "cache/a.vdb") == "shots/cache/a.vdb");
  CHECK(beside_scene(scene, "/cache/a.vdb") == "/cache/a.vdb");
}

TEST_CASE("a scene written out and read again is the same scene") {
  const SceneFile scene = parse_scene(scene_text, "shot.json");
  const std::string full = json_text(full_scene_json(scene)), small = json_text(short_scene_json(scene));
  CHECK(full_scene_json(parse_scene(full, "shot.json")) == full_scene_json(scene));
  CHECK(full_scene_json(parse_scene(small, "shot.json")) == full_scene_json(scene));
  CHECK(small.size() < full.size());
  CHECK(json_text(short_scene_json(parse_scene(small, "shot.json"))) == small);
}

TEST_CASE("--set changes values, list items by number and objects by name, and makes what is missing") {
  const auto with = [](const std::string& change) { return parse_scene(scene_text, "shot.json", {change}); };
  CHECK(with("film.samples=4").film.samples == 4);
  CHECK(with("objects.0.material.ior=2").objects[0].material.ior == 2);
  CHECK(with("objects.dragon.material={\"kind\":\"mirror\"}").objects[0].material.kind == "mirror");
  CHECK(with("objects.1.material.kind=mirror").objects[1].material.kind == "mirror");
  CHECK(with("objects.dragon.level_set=other.vdb").objects[0].path() == "other.vdb");
  CHECK(with("camera.eye=[1,2,3]").camera.eye == Vec3d(1, 2, 3));
  CHECK(with("camera.keys=[]").camera.keys.empty());
  CHECK(with("camera.keys.1.fov=20").camera.keys[1].fov == 20);
  CHECK(with("frames=1-5").frames == "1-5");
  CHECK(with("objects.1.transform.scale=3").objects[1].transform.scale == 3);
  CHECK(parse_scene(scene_text, "shot.json", {"film.samples=4", "film.samples=9"}).film.samples == 9);
}

// With LEVELRAY_UPDATE_README set it writes both instead of comparing (target `readme`).
TEST_CASE("the shipped schema and reference of scenes are those of the code") {
  const std::string folder = LEVELRAY_SOURCE_DIR "/data/";
  const std::string reference =
      "# Keys of a scene\n\nGenerated from `lib/levelray/io/scene_keys.hpp`; `cmake --build "
      "build/release --target readme` brings it up to date.\n\n" +
      scene_keys_table();
  if (std::getenv("LEVELRAY_UPDATE_README")) {
    std::ofstream(folder + "scene.schema.json") << scene_schema_text();
    std::ofstream(folder + "scene_keys.md") << reference;
    WARN("wrote the schema and the reference of scenes into " << folder);
  } else {
    CHECK(content(folder + "scene.schema.json") == scene_schema_text());
    CHECK(content(folder + "scene_keys.md") == reference);
  }
}
