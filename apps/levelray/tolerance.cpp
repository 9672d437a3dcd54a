#include "tolerance.hpp"

#include "levelray/core/error.hpp"
#include "levelray/intersect/intersectors.hpp"
#include "levelray/render/surface_extent.hpp"
#include "levelray/trace/trace.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <random>

namespace levelray {

namespace {

// The first of a seed's random places in the image. By the 64-bit Mersenne twister and arithmetic of our own,
// so that a seed gives the same rays everywhere.
std::vector<WorldRay> random_pixels(const CameraSettings& settings, std::uint64_t seed, std::size_t count) {
  const Camera camera(settings);
  std::mt19937_64 engine(seed);
  const auto unit = [&] { return static_cast<double>(engine() >> 11) * 0x1p-53; }; // [0,1)
  std::vector<WorldRay> rays(count);
  for (WorldRay& ray : rays) {
    const double x = unit() * settings.width, y = unit() * settings.height;
    ray = camera.ray(x, y);
  }
  return rays;
}

// The height of a pixel at the nearest of the places where a camera sees the surface, as 4096 random rays
// find them; where none does, at the middle of the surface.
double smallest_footprint(const LevelSet& level_set, const CameraSettings& settings) {
  const Camera camera(settings);
  const std::vector<WorldRay> rays = random_pixels(settings, 3, 4096);
  std::vector<Hit> hits(rays.size());
  closest_hits(level_set, rays, PrimaryOptions(), hits);
  double depth = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < rays.size(); ++i)
    if (hits[i]) depth = std::min(depth, hits[i].t * rays[i].direction.dot(camera.forward()));
  if (!std::isfinite(depth)) {
    const Box3d box = surface_bounds(level_set.grid());
    depth = box.isEmpty() ? 1 : std::fabs((box.center() - settings.eye).dot(camera.forward()));
  }
  return 2 * camera.half_height() * depth / settings.height;
}

Json achieved_json(const AchievedError& achieved) {
  return {{"share", 0.999},
          {"error", achieved.p999},
          {"max", achieved.largest},
          {"demonstrated", achieved.demonstrated},
          {"rays", achieved.rays},
          {"lost", achieved.lost},
          {"not_judged", achieved.not_judged}};
}

const char* storage_name(bool half) {
  return half ? "half" : "float";
}

// JSON knows no infinity.
Json finite_or_null(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

// A little above, with three digits, so that asking for it again asks for no less.
std::string rounded_up(double value) {
  const double unit = std::pow(10.0, std::floor(std::log10(value)) - 2);
  return fmt::format("{:.6g}", std::ceil(value / unit * (1 + 1e-9)) * unit);
}

class Asking {
 public:
  Asking(const ToleranceOption& option, const ToleranceLimits& limits, const InputOptions& input,
         const CommonOptions& common)
      : tolerance_(parse_tolerance(option.text)), limits_(limits), input_(input), common_(common) {
    if (tolerance_.pixels && !limits.picture)
      throw Error(ErrorKind::usage, "--tolerance " + printable(option.text, 80) +
                                        ": pixels are of a camera, and a conversion has none; give a length");
    parse_unit(input.units);
    if (limits.picture) limits.picture->check();
  }

  // For a surface in these bounds.
  ToleranceRequest request(const Box3d& bounds) const {
    ToleranceRequest request;
    request.intersector = canonical(limits_.intersector);
    request.normals = limits_.normals;
    request.half = limits_.half, request.stored = limits_.stored;
    request.least_voxel = limits_.least_voxel;
    request.fixed_voxel = limits_.voxel || in_voxels();
    if (limits_.picture) {
      const RenderOptions picture = limits_.picture->resolve_without_grid();
      request.picture_rays =
          static_cast<double>(picture.samples) * picture.camera.width * picture.camera.height;
    }
    if (tolerance_.pixels) {
      const PictureOptions& picture = *limits_.picture;
      const auto camera = [&picture](const LevelSet& level_set) {
        return picture.resolve(level_set.grid()).camera;
      };
      request.world = [value = tolerance_.value, camera](const LevelSet& level_set) {
        return value * smallest_footprint(level_set, camera(level_set));
      };
      request.rays = [camera](const LevelSet& level_set, std::uint64_t seed, std::size_t count) {
        return random_pixels(camera(level_set), seed, count);
      };
    } else if (in_voxels()) {
      request.world = [value = tolerance_.value](const LevelSet& level_set) {
        return value * level_set.grid().transform.voxel_size;
      };
    } else {
      LengthScale scale;
      scale.input = parse_unit(input_.units);
      scale.diagonal = bounds.isEmpty() ? 0 : bounds.size().length();
      const double world = resolve_length("--tolerance", tolerance_.length, scale);
      request.world = [world](const LevelSet&) { return world; };
      request.guess = world;
    }
    return request;
  }

  // The result for people and for --json; throws when it is a refusal.
  Json tell(const ToleranceResult& result, bool mesh) const {
    if (result.end != ToleranceEnd::met) refuse(result);
    if (common_.talks()) print(line(result, mesh));
    Json tried = Json::array();
    for (const ToleranceTrial& trial : result.tried)
      tried.push_back({{"voxel_size", trial.voxel_size},
                       {"storage", storage_name(trial.half)},
                       {"intersector", trial.intersector},
                       {"tolerance", trial.world},
                       {"demonstrated", finite_or_null(trial.demonstrated)}});
    return {{"asked", tolerance_.text},
            {"unit", tolerance_.unit()},
            {"world", result.world},
            {"chosen",
             {{"voxel_size", result.voxel_size},
              {"storage", storage_name(result.half)},
              {"intersector", result.intersector},
              {"normals", result.normals},
              {"normals_median_degrees", result.normals_median_degrees}}},
            {"achieved", achieved_json(result.achieved)},
            {"tried", tried}};
  }

 private:
  bool in_voxels() const { return !tolerance_.pixels && tolerance_.length.unit == Length::Unit::voxels; }

  static std::string canonical(const std::string& intersector) {
    return std::string(canonical_intersector(intersector));
  }

  // Of a length in world units, in the unit that was asked in.
  std::string in_unit(double world, const ToleranceResult& result, bool up = false) const {
    const double value = world / result.world * tolerance_.value;
    const std::string number = up ? rounded_up(value) : fmt::format("{:.3g}", value);
    return tolerance_.unit().empty() ? number : number + tolerance_.unit();
  }

  std::string line(const ToleranceResult& result, bool mesh) const {
    const std::string unit = input_.units.empty() ? "" : " " + input_.units;
    const AchievedError& a = result.achieved;
    std::string text = fmt::format(
        "tolerance {}: voxel {:.4g}{}, {}, {}, {}; achieved {} at p99.9, {} at most, on {}", tolerance_.text,
        result.voxel_size, unit, storage_name(result.half), result.intersector, result.normals,
        in_unit(a.p999, result), in_unit(a.largest, result), counted(a.rays, "ray", "rays"));
    if (a.lost > 0) text += fmt::format(" ({} of them lost)", with_commas(a.lost));
    if (a.not_judged > 0)
      text +=
          fmt::format("; {} more meet what closes holes, where there is no mesh", with_commas(a.not_judged));
    text += mesh ? "\n" : " against the grid's own surface\n";
    if (limits_.stored)
      text +=
          fmt::format("to trace it so: --intersector {} --normals {}\n", result.intersector, result.normals);
    return text;
  }

  [[noreturn]] void refuse(const ToleranceResult& result) const {
    const std::string head =
        fmt::format("{}: --tolerance {}: ", printable(input_.path, 200), printable(tolerance_.text, 40));
    const std::string voxel = fmt::format("voxels of {:.4g}", result.voxel_size);
    const std::string closest =
        std::isfinite(result.closest)
            ? "the closest that can be met is " + in_unit(result.closest, result, true)
            : "none can be met: too many rays see another surface, or none";
    switch (result.end) {
    case ToleranceEnd::fixed:
      throw Error(ErrorKind::limit,
                  fmt::format("{}cannot be met with {} and {}{}, which were asked for; {}", head, voxel,
                              result.intersector, result.half ? ", 16-bit floats" : "", closest));
    case ToleranceEnd::limited:
      throw Error(
          ErrorKind::limit,
          fmt::format("{}needs voxels finer than {:.4g}, the finest that --max-memory {} and the file's "
                      "format allow; {}",
                      head, result.voxel_size, bytes_text(input_.memory_limit()), closest));
    default:
      throw Error(ErrorKind::bad_input,
                  fmt::format("{}{} do not meet it, nor would finer ones: parts of the mesh bound no volume "
                              "(--thicken makes sheets of them) or are thinner than that; {}",
                              head, voxel, closest));
    }
  }

  const Tolerance tolerance_;
  const ToleranceLimits& limits_;
  const InputOptions& input_;
  const CommonOptions& common_;
};

} // namespace

std::string Tolerance::unit() const {
  std::string_view rest;
  double ignored = 0;
  return parse_number(text, &ignored, &rest) ? std::string(rest) : "";
}

Tolerance parse_tolerance(const std::string& text) {
  Tolerance tolerance;
  tolerance.text = text;
  std::string_view unit;
  if (parse_number(text, &tolerance.value, &unit) && unit == "px") {
    if (!(tolerance.value > 0))
      throw Error(ErrorKind::usage, "--tolerance " + printable(text, 80) + ": must be > 0");
    tolerance.pixels = true;
    return tolerance;
  }
  tolerance.length = parse_length("--tolerance", text);
  tolerance.value = tolerance.length.value;
  return tolerance;
}

void ToleranceOption::add_to(CLI::App& command, bool pixels) {
  command
      .add_option(
          "--tolerance", text,
          std::string(
              "Choose what is cheapest of what keeps 99.9 % of all rays within this distance of the "
              "mesh, both ways, and check it: a length as for --voxel, or vx (then the voxel is given)") +
              (pixels ? ", or px of the camera; of a .vdb: of its own surface" : ""))
      ->type_name("LENGTH")
      ->group("Conversion");
}

ToleranceLimits ToleranceLimits::of_convert(const CLI::App& command, bool half) {
  ToleranceLimits limits;
  limits.voxel = command.count("--voxel") + command.count("--resolution") > 0;
  if (command.count("--half") > 0) limits.half = half;
  limits.stored = true;
  limits.least_voxel = smallest_vdb_voxel_size();
  return limits;
}

ToleranceLimits ToleranceLimits::of_render(const CLI::App& command, const PictureOptions& picture) {
  ToleranceLimits limits;
  limits.voxel = command.count("--voxel") + command.count("--resolution") > 0;
  if (command.count("--intersector") > 0) limits.intersector = picture.intersector;
  if (command.count("--normals") > 0) limits.normals = picture.normals;
  limits.picture = &picture;
  return limits;
}

TolerableGrid load_to_tolerance(const ToleranceOption& option, const ToleranceLimits& limits,
                                const InputOptions& input, const ConversionOptions& conversion,
                                const CommonOptions& common, Progress& progress) {
  const Asking asking(option, limits, input, common);
  if (!conversion.thicken.empty() && !limits.voxel &&
      parse_length("--thicken", conversion.thicken).unit == Length::Unit::voxels)
    throw Error(ErrorKind::usage, "--thicken " + printable(conversion.thicken, 80) +
                                      ": the tolerance is to choose the voxel; give a length");
  TolerableGrid result;
  if (is_vdb(input.path)) {
    result.loaded = load_grid(input, conversion, common, progress);
    const BlockGrid& grid = result.loaded.grid;
    result.chosen = trace_to_tolerance(grid, asking.request(surface_bounds(grid)));
    result.json = asking.tell(result.chosen, false);
    return result;
  }
  result.loaded = convert_mesh(
      input, conversion, common, progress, nullptr,
      [&](const PreparedMesh& mesh, const ConvertOptions& options) {
        ToleranceRequest request = asking.request(mesh.report.bounds);
        request.convert = options;
        const Length band = parse_length("--band", conversion.band);
        if (!request.fixed_voxel && band.unit != Length::Unit::plain && band.unit != Length::Unit::voxels) {
          const Vec3d size = mesh.report.bounds.size(); // what resolve() made voxels of
          request.band = options.half_width_voxels * std::max({size.x, size.y, size.z}) / options.resolution;
        }
        progress.begin("voxel size", 0, "");
        result.chosen = convert_to_tolerance(mesh, request);
        progress.finish();
        result.json = asking.tell(result.chosen, true);
        ConvertedGrid converted = std::move(*result.chosen.converted);
        result.chosen.converted.reset();
        return converted;
      });
  return result;
}

} // namespace levelray
