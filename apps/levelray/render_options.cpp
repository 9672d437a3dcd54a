#include "render_options.hpp"

#include "levelray/core/error.hpp"
#include "levelray/core/methods.hpp"
#include "levelray/intersect/intersectors.hpp"
#include "levelray/normal/normals.hpp"
#include "names.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace levelray {

namespace {

const std::vector<std::string> counter_names{"steps",   "tests",        "interpolations",
                                             "samples", "shadow_steps", "shadow_tests"};

// "512x512"
void parse_size(const std::string& text, CameraSettings& camera) {
  double width = 0, height = 0;
  std::string_view rest = text;
  const bool good = parse_number(rest, &width, &rest) && rest.starts_with('x') &&
                    parse_number(rest.substr(1), &height, &rest) && rest.empty() &&
                    width == std::floor(width) && height == std::floor(height) && width >= 1 &&
                    width <= 65536 && height >= 1 && height <= 65536;
  if (!good)
    throw Error(ErrorKind::usage, "--size " + printable(text, 80) + ": not WxH with both from 1 to 65536");
  camera.width = static_cast<int>(width);
  camera.height = static_cast<int>(height);
}

// "x,y,z" or "x,y,z,intensity"
DirectionalLight parse_light(const std::string& text) {
  DirectionalLight light;
  std::string direction = text;
  if (std::count(text.begin(), text.end(), ',') == 3) {
    const std::size_t comma = text.rfind(',');
    direction.resize(comma);
    std::string_view rest;
    if (!parse_number(std::string_view(text).substr(comma + 1), &light.intensity, &rest) || !rest.empty() ||
        !(light.intensity >= 0))
      throw Error(ErrorKind::usage,
                  "--light " + printable(text, 80) + ": the intensity is not a number >= 0");
  }
  const Vec3d v = parse_vector("--light", direction);
  if (!(v.length() > 0))
    throw Error(ErrorKind::usage, "--light " + printable(text, 80) + ": has no direction");
  light.to_light = v.normalized();
  return light;
}

Json vector_json(const Vec3d& v) {
  return {v.x, v.y, v.z};
}

} // namespace

void PictureOptions::add_to(CLI::App& command) {
  command.add_option("--output,-o", outputs, "An .exr or .png to write; may be repeated")
      ->allow_extra_args(false)
      ->type_name("FILE");
  add_look_to(command);
}

void PictureOptions::add_look_to(CLI::App& command) {
  const std::string camera = "Camera", image = "Picture";
  command.add_option("--size", size, "Pixels")->capture_default_str()->type_name("WxH")->group(camera);
  command.add_option("--eye", eye, "Where the camera stands; default: so that all is seen")
      ->type_name("X,Y,Z")
      ->group(camera);
  command.add_option("--target", target, "What it looks at; default: the middle of the surface")
      ->type_name("X,Y,Z")
      ->group(camera);
  command.add_option("--up", up, "What is up: in the picture, and for the ground")
      ->capture_default_str()
      ->type_name("X,Y,Z")
      ->group(camera);
  command.add_option("--fov", fov, "Vertical field of view, degrees")
      ->capture_default_str()
      ->type_name("D")
      ->group(camera);

  command
      .add_option("--light", lights,
                  "Direction towards a distant light, and its intensity (1); may be repeated")
      ->allow_extra_args(false)
      ->type_name("X,Y,Z[,I]")
      ->group(image);
  command.add_flag("--shadows", shadows, "Cast hard shadows")->group(image);
  command.add_flag("--ground", ground, "Put a plane under the lowest point")->group(image);
  command.add_option("--shading", shading, "Surface: " + join(shading_names()))
      ->capture_default_str()
      ->type_name("NAME")
      ->group(image);
  command.add_option("--samples", samples, "Rays per pixel: 1, 4, 9, 16, ... on a regular grid")
      ->capture_default_str()
      ->type_name("N")
      ->group(image);
  command
      .add_option("--aov", aovs,
                  "More channels for .exr: all, or some of " + join(aov_names()) + ", with commas")
      ->type_name("LIST")
      ->group(image);
  command
      .add_option("--show", show,
                  "Show rays' work in false colours instead of the picture: " + join(counter_names))
      ->type_name("NAME")
      ->group(image);
  command
      .add_option("--intersector", intersector,
                  "How rays meet a cell's surface: " + join(method_names<Intersectors>()))
      ->capture_default_str()
      ->type_name("NAME")
      ->group(image);
  command.add_option("--normals", normals, "How normals are found: " + join(method_names<NormalSchemes>()))
      ->capture_default_str()
      ->type_name("NAME")
      ->group(image);
  acceleration.add_to(command, "Speed (the picture stays the same)");
  command.add_option("--repeat", repeat, "Render K times and report median, min and max of the times")
      ->check(CLI::Range(1, 100000))
      ->type_name("K")
      ->group(image);
}

RenderOptions PictureOptions::resolve_without_grid() const {
  RenderOptions options;
  parse_size(size, options.camera);
  options.camera.fov_degrees = fov;
  options.camera.up = parse_vector("--up", up);
  if (!eye.empty()) options.camera.eye = parse_vector("--eye", eye);
  if (!target.empty()) options.camera.target = parse_vector("--target", target);
  if (!eye.empty() && !target.empty()) const Camera legal(options.camera);
  if (!(fov > 0 && fov < 180)) throw Error(ErrorKind::usage, "--fov must be within (0,180) degrees");
  if (!(options.camera.up.length() > 0)) throw Error(ErrorKind::usage, "--up has no direction");

  for (const std::string& light : lights) options.lights.push_back(parse_light(light));
  options.shadows = shadows;
  options.ground = ground;
  find_name("--shading", shading, shading_names());
  options.shading = shading;
  options.samples = samples;
  if (!aovs.empty())
    for (const std::string& name : aovs == "all" ? aov_names() : split_list(aovs)) {
      find_name("--aov", name, aov_names());
      if (std::count(options.aovs.begin(), options.aovs.end(), name) == 0) options.aovs.push_back(name);
    }
  if (!show.empty()) {
    find_name("--show", show, counter_names);
    if (std::count(options.aovs.begin(), options.aovs.end(), show) == 0) options.aovs.push_back(show);
  }
  options.intersector = canonical_intersector(intersector);
  find_name("--intersector", options.intersector, method_names<Intersectors>());
  find_name("--normals", normals, method_names<NormalSchemes>());
  options.normals = normals;
  options.repeat = repeat;
  options.acceleration = acceleration.resolve();
  check_render_options(options);
  return options;
}

RenderOptions PictureOptions::resolve(const BlockGrid& grid) const {
  Framing surface(resolve_without_grid().camera);
  if (needs_framing()) surface.add(grid);
  return resolve(surface);
}

RenderOptions PictureOptions::resolve(const Framing& surfaces) const {
  RenderOptions options = resolve_without_grid();
  CameraSettings& camera = options.camera;
  if (needs_framing()) {
    const CameraSettings frame = surfaces.camera();
    if (eye.empty()) camera.eye = target.empty() ? frame.eye : camera.target + (frame.eye - frame.target);
    if (target.empty()) camera.target = frame.target;
  }
  if (options.lights.empty()) options.lights = three_point_lights(Camera(camera));
  return options;
}

Json PictureOptions::json(const RenderOptions& resolved, int threads) const {
  const CameraSettings& camera = resolved.camera;
  Json lights_json = Json::array();
  for (const DirectionalLight& light : resolved.lights)
    lights_json.push_back({{"direction", vector_json(light.to_light)}, {"intensity", light.intensity}});
  Json json = {{"size", {camera.width, camera.height}},
               {"eye", vector_json(camera.eye)},
               {"target", vector_json(camera.target)},
               {"up", vector_json(camera.up)},
               {"fov", camera.fov_degrees},
               {"intersector", resolved.intersector},
               {"normals", resolved.normals},
               {"lights", lights_json},
               {"shading", resolved.shading},
               {"shadows", resolved.shadows},
               {"ground", resolved.ground},
               {"samples", resolved.samples},
               {"aov", resolved.aovs},
               {"show", show},
               {"repeat", resolved.repeat},
               {"threads", threads},
               {"output", outputs}};
  json.update(acceleration.json());
  return json;
}

} // namespace levelray
