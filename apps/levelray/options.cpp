#include "options.hpp"

#include "levelray/core/error.hpp"
#include "levelray/io/output_file.hpp"
#include "names.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <unistd.h>

namespace levelray {

namespace fs = std::filesystem;

namespace {
const std::vector<std::string> redistance_names{"auto", "always", "never"};
}

void CommonOptions::add_to(CLI::App& command) {
  command.add_option("--threads,-j", threads, "Threads to use; 0: all")->check(CLI::Range(0, 4096));
  command.add_flag("--quiet,-q", quiet, "Print warnings and errors only");
  command
      .add_option("--json", json,
                  "Write facts and times as JSON to FILE; -: to standard output, and nothing else")
      ->type_name("FILE|-");
}

void InputOptions::add_to(CLI::App& command) {
  const std::string group = "Input";
  command.add_option("--format", format, "Read the mesh as obj, ply, stl or off, whatever it looks like")
      ->type_name("NAME")
      ->group(group);
  command.add_option("--units", units, "What a coordinate of the mesh means: mm, cm, m or in")
      ->type_name("UNIT")
      ->group(group);
  command.add_flag("--drop-bad", drop_bad, "Drop faces with coordinates that are not finite")->group(group);
  command.add_flag("--salvage", salvage, "Take what is there of a truncated mesh")->group(group);
  command.add_flag("--trust-orientation", trust_orientation, "Turn no triangle round")->group(group);
  command.add_flag("--strict", strict, "Refuse meshes that are not closed, manifold and oriented (exit 3)")
      ->group(group);
  command.add_option("--grid", grid, "Grid of a .vdb: NAME, NAME[i] for the i-th of that name, or [i]")
      ->type_name("NAME")
      ->group(group);
  command
      .add_flag("--trust-input", trust_input,
                "Read a .vdb in this process instead of a limited one of its own")
      ->group(group);
  command.add_option("--read-timeout", read_timeout, "Give up reading a .vdb after so many seconds")
      ->check(CLI::Range(0.01, 1e6))
      ->capture_default_str()
      ->type_name("S")
      ->group(group);
  command
      .add_option("--max-memory", max_memory,
                  "Refuse work that needs more, e.g. 8GiB (exit 5); 0: no limit; default: 80% of the "
                  "machine's memory")
      ->type_name("SIZE")
      ->group(group);
}

MeshReadOptions InputOptions::mesh_options() const {
  MeshReadOptions options;
  options.format = format;
  options.drop_bad = drop_bad;
  options.salvage = salvage;
  options.max_memory = memory_limit();
  return options;
}

VdbReadOptions InputOptions::vdb_options() const {
  VdbReadOptions options;
  options.grid = grid;
  options.trust_input = trust_input;
  options.max_memory = memory_limit();
  options.timeout_seconds = read_timeout;
  return options;
}

CommonOptions CommonOptions::silent() {
  CommonOptions options;
  options.quiet = options.keep_warnings = true;
  return options;
}

Json InputOptions::json() const {
  return {{"input", path},
          {"format", format},
          {"units", units},
          {"drop_bad", drop_bad},
          {"salvage", salvage},
          {"trust_orientation", trust_orientation},
          {"strict", strict},
          {"grid", grid},
          {"trust_input", trust_input},
          {"read_timeout", read_timeout},
          {"max_memory", memory_limit()}};
}

Json InputOptions::lasting_json() const {
  Json lasting = json();
  for (const char* key : {"input", "trust_input", "read_timeout", "max_memory"}) lasting.erase(key);
  return lasting;
}

InputOptions InputOptions::of_frame(const std::string& frame_path, std::uint64_t memory,
                                    double seconds) const {
  InputOptions frame = *this;
  frame.path = frame_path;
  frame.max_memory = std::to_string(std::max<std::uint64_t>(memory, 1)); // 0 would mean no limit
  frame.read_timeout = std::min(frame.read_timeout, seconds);
  return frame;
}

std::uint64_t InputOptions::memory_limit() const {
  constexpr std::uint64_t unlimited = std::uint64_t{1} << 62; // leaves room for sums
  if (!max_memory.empty()) {
    const std::uint64_t limit = parse_bytes("--max-memory", max_memory);
    return limit > 0 ? limit : unlimited;
  }
  const long pages = ::sysconf(_SC_PHYS_PAGES), page_size = ::sysconf(_SC_PAGESIZE);
  if (pages <= 0 || page_size <= 0) return std::uint64_t{8} << 30;
  return static_cast<std::uint64_t>(pages) * static_cast<std::uint64_t>(page_size) / 5 * 4;
}

void ConversionOptions::add_to(CLI::App& command) {
  const std::string group = "Conversion";
  auto* by_resolution =
      command.add_option("--resolution", resolution, "Voxels along the longest side of the mesh")
          ->capture_default_str()
          ->check(CLI::Range(1, 1 << 20))
          ->type_name("N")
          ->group(group);
  command
      .add_option("--voxel", voxel,
                  "Voxel size instead: a plain number in the mesh's own units, or with mm, cm, m, in (needs "
                  "--units), "
                  "or % of the bounding box's diagonal")
      ->type_name("LENGTH")
      ->excludes(by_resolution)
      ->group(group);
  command
      .add_option(
          "--band", band,
          "Half-width of the band: a plain number or vx in voxels; mm, cm, m, in and % as for --voxel")
      ->capture_default_str()
      ->type_name("LENGTH")
      ->group(group);
  auto* by_sign = command.add_option("--sign", sign, "What is inside: " + join(sign_method_names()))
                      ->capture_default_str()
                      ->type_name("NAME")
                      ->group(group);
  command
      .add_option(
          "--thicken", thicken,
          "Make a sheet of all within R of the mesh (2R thick), for cloth and other open meshes: a plain "
          "number, mm, cm, m, in and % as for --voxel, or vx in voxels")
      ->excludes(by_sign)
      ->type_name("R")
      ->group(group);
  command
      .add_option("--iso", iso,
                  "Take a fog volume of a .vdb for a solid: its surface is where the density has this value")
      ->type_name("VALUE")
      ->group(group);
  command
      .add_flag(
          "--redistance{always}", redistance,
          "Make distances of a .vdb's values, to where they change sign; =auto (default): where they are "
          "none; =never: trace them as they are")
      ->group(group);
}

float ConversionOptions::iso_value() const {
  double value = 0;
  std::string_view rest;
  if (!parse_number(iso, &value, &rest) || !rest.empty() || !(static_cast<float>(value) > 0) ||
      !std::isfinite(static_cast<float>(value)))
    throw Error(ErrorKind::usage, "--iso " + printable(iso, 80) + ": not a density; write a number > 0");
  return static_cast<float>(value);
}

VdbReadOptions ConversionOptions::vdb_options(const InputOptions& input) const {
  VdbReadOptions options = input.vdb_options();
  constexpr Redistance policies[] = {Redistance::automatic, Redistance::always, Redistance::never};
  options.redistance = policies[find_name("--redistance", redistance, redistance_names)];
  const Length width = parse_length("--band", band);
  if (width.unit != Length::Unit::plain && width.unit != Length::Unit::voxels)
    throw Error(ErrorKind::usage,
                "--band " + printable(band, 80) + ": give it in voxels for a .vdb, such as 3vx");
  options.redistance_half_width_voxels = width.value;
  if (!iso.empty()) options.iso = iso_value();
  return options;
}

void ConversionOptions::check() const {
  if (!voxel.empty() && parse_length("--voxel", voxel).unit == Length::Unit::voxels)
    throw Error(ErrorKind::usage, "--voxel " + printable(voxel, 80) + ": cannot be given in voxels");
  parse_length("--band", band);
  if (!thicken.empty()) parse_length("--thicken", thicken);
  find_name("--sign", sign, sign_method_names());
  find_name("--redistance", redistance, redistance_names);
  if (!iso.empty()) iso_value();
}

Json ConversionOptions::json() const {
  Json options{{"band", band}, {"sign", sign}, {"redistance", redistance}};
  if (voxel.empty())
    options["resolution"] = resolution;
  else
    options["voxel"] = voxel;
  if (!thicken.empty()) options["thicken"] = thicken;
  if (!iso.empty()) options["iso"] = iso_value();
  return options;
}

ConvertOptions ConversionOptions::resolve(const Box3d& bounds, const InputOptions& input) const {
  LengthScale scale;
  scale.input = parse_unit(input.units);
  const Vec3d size = bounds.isEmpty() ? Vec3d(0, 0, 0) : bounds.size();
  scale.diagonal = size.length();
  const double longest = std::max({size.x, size.y, size.z});

  ConvertOptions options;
  options.resolution = resolution;
  if (!voxel.empty()) {
    options.voxel_size = resolve_length("--voxel", parse_length("--voxel", voxel), scale);
    if (options.voxel_size > longest)
      throw Error(ErrorKind::usage,
                  fmt::format("--voxel {}: larger than the mesh, whose longest side is {:.6g}",
                              printable(voxel, 80), longest));
  }
  scale.voxel_size = options.voxel_size > 0 ? options.voxel_size : longest / resolution;
  const Length width = parse_length("--band", band);
  options.half_width_voxels = width.unit == Length::Unit::plain || width.unit == Length::Unit::voxels
                                  ? width.value
                                  : resolve_length("--band", width, scale) / scale.voxel_size;
  if (!thicken.empty())
    options.thicken = resolve_length("--thicken", parse_length("--thicken", thicken), scale);
  options.sign = static_cast<SignMethod>(find_name("--sign", sign, sign_method_names()));
  options.max_memory = input.memory_limit();
  return options;
}

std::string extension_of(const std::string& path) {
  std::string extension = fs::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

void check_output(const std::string& path, const std::string& input,
                  const std::vector<std::string>& extensions, std::vector<std::string>& outputs_so_far) {
  const auto refuse = [&](const std::string& reason) {
    throw Error(ErrorKind::usage, printable(path, 300) + ": " + reason);
  };
  if (!extensions.empty() &&
      std::find(extensions.begin(), extensions.end(), extension_of(path)) == extensions.end())
    refuse("unknown output extension; choose " + join(extensions));
  std::error_code ignored;
  const fs::path folder = fs::path(path).parent_path();
  if (!folder.empty() && !fs::is_directory(folder, ignored))
    refuse("the output's folder does not exist; create it first");
  const auto same = [&](const std::string& other) {
    return fs::absolute(path, ignored).lexically_normal() ==
               fs::absolute(other, ignored).lexically_normal() ||
           fs::equivalent(path, other, ignored);
  };
  if (same(input)) refuse("the output is the input");
  for (const std::string& other : outputs_so_far)
    if (same(other)) refuse("is written twice");
  outputs_so_far.push_back(path);
  check_writable(path);
}

} // namespace levelray
