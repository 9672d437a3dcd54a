#include "levelray/io/scene_frame.hpp"

#include "support/catch.hpp"

using namespace levelray;

namespace {

const std::string scene_text = R"({
  "levelray": 1, "frames": "1-10", "outputs": ["a.####.png"],
  "camera": {"eye": [0, 1, 5], "target": [0, 0, 0], "keys": [{"frame": 1, "fov": 40}, {"frame": 3, "fov": 20}]},
  "objects": [
    {"name": "a", "mesh": "x.obj"},
    {"mesh": "x.obj", "transform": {"translate": [1, 0, 0]}, "material": {"kind": "glass"}, "id": 40},
    {"mesh": "x.obj", "convert": {"resolution": 128}, "material": {"kind": "mirror", "tint": [1, 0.5, 0]}},
    {"mesh": "x.obj", "convert": {"resolution": 256}, "shadows": false},
    {"level_set": "y.####.vdb", "grid": "one",
     "transform": {"keys": [{"frame": 1, "scale": 1}, {"frame": 3, "scale": 4}]}},
    {"level_set": "y.####.vdb", "grid": "two"},
    {"level_set": "y.####.vdb", "grid": "one"}
  ],
  "lights": [{"kind": "directional", "direction": [0, 3, 0], "intensity": 2},
             {"kind": "point", "position": [1, 2, 3], "color": [1, 0, 0], "shadows": false}],
  "ambient": 0.5, "sky": {"radiance": [1, 2, 3]}, "ground": {"radius": 2},
  "ambient_occlusion": {"samples": 9}, "render": {"max_depth": 2}
})";

std::string text_at(const std::vector<std::string>& overrides, double frame = 1) {
  const SceneFile scene = parse_scene(scene_text, "shots/shot.json", overrides);
  return frame_text(scene, scene_inputs(scene), frame);
}

} // namespace

TEST_CASE("objects that say the same about the same file share it") {
  const SceneFile scene = parse_scene(scene_text, "shots/shot.json");
  const SceneInputs inputs = scene_inputs(scene);
  CHECK(inputs.of_object == std::vector<std::size_t>{0, 0, 1, 0, 2, 3, 2});
  REQUIRE(inputs.files.size() == 4);
  CHECK(inputs.files[0].path == "shots/x.obj");
  CHECK(inputs.files[0].is_mesh);
  CHECK(inputs.files[1].convert.resolution == 128);
  CHECK(inputs.files[3].grid == "two");
  CHECK(inputs.files[3].path == "shots/y.####.vdb");
}

TEST_CASE("a scene file becomes a scene") {
  const SceneFile file = parse_scene(scene_text, "shots/shot.json");
  const SceneInputs inputs = scene_inputs(file);
  const BlockGrid grids[4];
  const BlockGrid* pointers[] = {&grids[0], &grids[1], &grids[2], &grids[3]};
  const Scene scene = scene_at(file, inputs, 2, pointers);
  CHECK_NOTHROW(check_scene(scene));
  REQUIRE(scene.instances.size() == 7);
  for (std::size_t i = 0; i < 7; ++i) CHECK(scene.instances[i].grid == &grids[inputs.of_object[i]]);
  CHECK(scene.instances[0].id == 1);
  CHECK(scene.instances[1].id == 40);
  CHECK(scene.instances[2].id == 3);
  CHECK(scene.instances[0].world_from_object.is_identity());
  CHECK(scene.instances[0].material.kind == MaterialKind::phong);
  CHECK(scene.instances[0].material.specular == shading_material("phong").specular);
  CHECK(scene.instances[1].world_from_object.point(Vec3d(1, 1, 1)) == Vec3d(2, 1, 1));
  CHECK(scene.instances[1].material.kind == MaterialKind::glass);
  CHECK(scene.instances[1].material.specular == 0);
  CHECK(scene.instances[2].material.kind == MaterialKind::mirror);
  CHECK(scene.instances[2].material.tint == Vec3d(1, 0.5, 0));
  CHECK(!scene.instances[3].casts_shadows);
  CHECK(std::abs(scene.instances[4].world_from_object.scale - 2) < 1e-15); // half way, by factors
  REQUIRE(scene.directional_lights.size() == 1);
  CHECK(scene.directional_lights[0].to_light == Vec3d(0, 1, 0));
  CHECK(scene.directional_lights[0].intensity == 2);
  CHECK(scene.directional_lights[0].casts_shadows);
  REQUIRE(scene.point_lights.size() == 1);
  CHECK(scene.point_lights[0].position == Vec3d(1, 2, 3));
  CHECK(scene.point_lights[0].color == Vec3d(1, 0, 0));
  CHECK(!scene.point_lights[0].casts_shadows);
  CHECK(scene.ambient == 0.5);
  CHECK(scene.sky.radiance == Vec3d(1, 2, 3));
  CHECK(scene.ground->radius == 2);
  CHECK(!scene.ground->height);
  CHECK(scene.ground->material.albedo == GroundSettings().material.albedo);
  CHECK(scene.ambient_occlusion.samples == 9);
  CHECK(scene.max_depth == 2);
  CHECK(render_options_at(file, 2).camera.fov_degrees == 30);
}

TEST_CASE("a frame's text changes with what changes the picture, and with nothing else") {
  const std::string before = text_at({});
  CHECK(text_at({}) == before);
  CHECK(before.find('\n') == std::string::npos);
  for (const char* same :
       {"frames=1-20", "fps=30", "outputs=[]", "objects.a.name=b", "objects.4.level_set=z.####.vdb",
        "limits.memory=1GiB", "camera.keys.1.frame=9", "objects.4.transform.keys.1.scale=7"}) {
    INFO(same);
    if (std::string(same).starts_with("objects.4.level_set")) // also the other object of that file
      CHECK(text_at({same, "objects.6.level_set=z.####.vdb", "objects.5.level_set=z.####.vdb"}) == before);
    else
      CHECK(text_at({same}) == before);
  }
  for (const char* other : {"camera.fov=30",
                            "camera.eye=[0,1,4]",
                            "film.samples=4",
                            "film.size=[8,8]",
                            "film.aov=[\"Z\"]",
                            "objects.a.material.kind=diffuse",
                            "objects.a.id=9",
                            "objects.1.transform.translate=[1,0,1]",
                            "objects.1.mesh=other.obj",
                            "objects.2.convert.resolution=127",
                            "objects.5.grid=three",
                            "objects.5.redistance=always",
                            "objects.3.shadows=true",
                            "lights.0.intensity=1",
                            "lights=[]",
                            "ambient=0.4",
                            "sky.visible=true",
                            "ground.height=0",
                            "ambient_occlusion.samples=4",
                            "render.max_depth=3",
                            "render.intersector=midpoint"}) {
    INFO(other);
    // The frame's field of view comes from its keys.
    CHECK((text_at({other}) == before) == (std::string(other) == "camera.fov=30"));
  }
  CHECK(text_at({}, 2) != before);
  CHECK(text_at({}, 3) == text_at({}, 4)); // at rest
}
