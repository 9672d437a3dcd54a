// levelray compare: two pictures, or two level sets.
#include "commands.hpp"
#include "input.hpp"
#include "levelray/core/error.hpp"
#include "levelray/core/parallel.hpp"
#include "levelray/io/exr_reader.hpp"
#include "levelray/io/exr_writer.hpp"
#include "levelray/io/output_file.hpp"
#include "levelray/io/png_writer.hpp"
#include "levelray/measure/compare_grids.hpp"
#include "levelray/measure/compare_pictures.hpp"

#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <memory>

namespace levelray {

namespace {

// A threshold as it was typed.
struct ThresholdOption {
  const char* name;
  double Thresholds::*value;
  const char* help;
  std::string text;
};

struct Compare {
  CommonOptions common;
  InputOptions a, b; // of both only the path differs
  std::vector<ThresholdOption> thresholds{
      {"--fail", &Thresholds::fail, "Pixels or samples fail that differ by more", "1e-6"},
      {"--failpercent", &Thresholds::fail_percent, "Allow this percentage of them to fail", "0"},
      {"--hardfail", &Thresholds::hard_fail, "Allow none to differ by more", "inf"},
      {"--warn", &Thresholds::warn, "Warn of pixels or samples that differ by more", "1e-6"},
      {"--warnpercent", &Thresholds::warn_percent, "Warn when more than this percentage do", "0"},
      {"--hardwarn", &Thresholds::hard_warn, "Warn when any differs by more", "inf"}};
  std::uint64_t allow_failures = 0;
  std::string diff;
  bool nan_fail = false;

  void run();
  Thresholds resolve() const;
  Verdict compare_exr(const Thresholds& limits, Json& json, std::string& summary) const;
  Verdict compare_vdb(const Thresholds& limits, Json& json, std::string& summary) const;
  std::string names() const {
    return fmt::format("{} and {}", printable(a.path, 120), printable(b.path, 120));
  }
};

Thresholds Compare::resolve() const {
  Thresholds result;
  for (const ThresholdOption& option : thresholds) {
    double value = std::numeric_limits<double>::infinity();
    std::string_view rest;
    if (option.text != "inf" && (!parse_number(option.text, &value, &rest) || !rest.empty() || !(value >= 0)))
      throw Error(ErrorKind::usage, fmt::format("{} \"{}\": must be a number >= 0, or inf", option.name,
                                                printable(option.text, 80)));
    result.*option.value = value;
  }
  result.allow_failures = allow_failures;
  return result;
}

enum class Kind { exr, vdb };

// By extension, or by the first bytes of a file of another name.
Kind kind_of(const std::string& path) {
  if (extension_of(path) == ".exr") return Kind::exr;
  if (is_vdb(path)) return Kind::vdb;
  std::error_code ignored;
  char first[4] = {};
  if (std::filesystem::is_regular_file(path, ignored))
    if (std::ifstream(path, std::ios::binary).read(first, 4) &&
        std::string_view(first, 4) == "\x76\x2f\x31\x01")
      return Kind::exr;
  throw Error(ErrorKind::usage, printable(path, 300) + ": compare takes two .exr or two .vdb");
}

const char* name_of(Verdict verdict) {
  return verdict == Verdict::pass ? "pass" : verdict == Verdict::warning ? "warning" : "failure";
}

// JSON has no infinity: null.
Json number_json(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json statistics_json(const DifferenceStatistics& s) {
  return {{"mean_error", s.mean},         {"rms_error", s.rms},
          {"psnr", number_json(s.psnr)},  {"max_error", number_json(s.max)},
          {"max_at", {s.max_x, s.max_y}}, {"not_finite", s.not_finite}};
}

std::string counts_text(const ThresholdCount& count, const Thresholds& limits, const char* things) {
  return fmt::format("{} of {} {} ({:.3g}%) over {:.3g}, {} ({:.3g}%) over {:.3g}\n",
                     with_commas(count.warned()), with_commas(count.total()), things,
                     count.percent(count.warned()), limits.warn, with_commas(count.failed()),
                     count.percent(count.failed()), limits.fail);
}

void add_counts(Json& json, const ThresholdCount& count, const char* things) {
  json[things] = count.total();
  json["failed"] = count.failed();
  json["failed_percent"] = count.percent(count.failed());
  json["warned"] = count.warned();
  json["warned_percent"] = count.percent(count.warned());
}

Verdict Compare::compare_exr(const Thresholds& limits, Json& json, std::string& summary) const {
  ExrReadOptions read;
  read.trust_input = a.trust_input;
  read.max_memory = a.memory_limit();
  const ExrFile first = read_exr(a.path, read), second = read_exr(b.path, read);
  PictureCompareOptions options{limits, nan_fail};
  const PictureComparison result = compare_pictures(first.picture, second.picture, options);

  std::vector<std::string> warnings = first.warnings;
  warnings.insert(warnings.end(), second.warnings.begin(), second.warnings.end());
  warnings.insert(warnings.end(), result.remarks.begin(), result.remarks.end());
  for (const std::string& warning : warnings) print_warning(warning);
  json["mismatch"] = result.mismatch;
  json["warnings"] = warnings;
  for (const auto& [key, file] : {std::pair{"size_a", &first}, {"size_b", &second}})
    json[key] = {width_of(file->picture.display_window), height_of(file->picture.display_window)};
  if (!result.mismatch.empty()) {
    if (!diff.empty()) print_warning("no --diff of pictures that do not match");
    summary = result.mismatch;
    return Verdict::failure;
  }

  const DifferenceStatistics& all = result.all;
  json.update(statistics_json(all));
  json["max_channel"] = result.max_channel;
  add_counts(json, result.pixels, "pixels");
  json["channels"] = Json::object();
  for (const auto& [name, s] : result.channels) json["channels"][name] = statistics_json(s);
  if (common.talks()) {
    print(fmt::format("{}: {} x {} pixels, {}\n", names(), width_of(result.window), height_of(result.window),
                      counted(result.channels.size(), "channel", "channels")));
    print(fmt::format("mean error {:.6g}, rms error {:.6g}, peak SNR {:.4g} dB\n", all.mean, all.rms,
                      all.psnr));
    if (all.max > 0)
      print(fmt::format("max error {:.6g} at ({}, {}) in {}\n", all.max, all.max_x, all.max_y,
                        printable(result.max_channel, 60)));
    if (all.not_finite > 0)
      print(fmt::format("{} not finite in one only\n", counted(all.not_finite, "value is", "values are")));
    if (all.max > 0 && result.channels.size() > 1)
      for (const auto& [name, s] : result.channels)
        print(fmt::format("  {:8} mean {:.6g}, rms {:.6g}, max {:.6g} at ({}, {})\n", printable(name, 60),
                          s.mean, s.rms, s.max, s.max_x, s.max_y));
    print(counts_text(result.pixels, limits, "pixels"));
  }
  if (!diff.empty()) {
    const bool png = extension_of(diff) == ".png";
    const Image image = png ? difference_colours(first.picture, second.picture, result, options)
                            : signed_difference(first.picture, second.picture, result);
    ExrOptions write;
    write.software = "levelray " LEVELRAY_VERSION;
    write.comments = "A - B";
    write.all_float = true;
    write_file_atomically(diff, png ? encode_png(image) : encode_exr(image, write));
    if (common.talks()) print(fmt::format("wrote {}\n", printable(diff, 300)));
  }
  summary = fmt::format("{} of {} pixels differ by more than {:.6g}, at most by {:.6g}",
                        with_commas(result.pixels.failed()), with_commas(result.pixels.total()), limits.fail,
                        all.max);
  return result.pixels.verdict();
}

Verdict Compare::compare_vdb(const Thresholds& limits, Json& json, std::string& summary) const {
  if (!diff.empty()) throw Error(ErrorKind::usage, "--diff: only pictures have a difference image");
  if (nan_fail) throw Error(ErrorKind::usage, "--nan-fail: a level set holds no NaN; it is for pictures");
  const VdbFile first = read_vdb(a.path, a.vdb_options()), second = read_vdb(b.path, b.vdb_options());
  GridComparison result = compare_grids(first.grid, second.grid, limits);

  std::vector<std::string> warnings;
  for (const auto& [path, file] : {std::pair{&a.path, &first}, {&b.path, &second}})
    for (const std::string& warning : file->warnings)
      warnings.push_back(printable(*path, 200) + ": " + warning);
  warnings.insert(warnings.end(), result.remarks.begin(), result.remarks.end());
  for (const std::string& warning : warnings) print_warning(warning);
  json["mismatch"] = result.mismatch;
  json["warnings"] = warnings;
  json["grid_a"] = grid_json(first.grid);
  json["grid_b"] = grid_json(second.grid);
  if (!result.mismatch.empty()) {
    summary = result.mismatch;
    return Verdict::failure;
  }
  json["unit"] = "voxels";
  json["mean_error"] = result.mean;
  json["rms_error"] = result.rms;
  json["max_error"] = result.max;
  json["max_at"] = {result.max_at.x, result.max_at.y, result.max_at.z};
  json["max_position"] = {result.max_position.x, result.max_position.y, result.max_position.z};
  add_counts(json, result.samples, "samples");
  json["active_a"] = result.active_a;
  json["active_b"] = result.active_b;
  json["only_in_a"] = result.only_in_a;
  json["only_in_b"] = result.only_in_b;
  json["sign_flips"] = result.sign_flips;
  json["inactive_flips"] = result.inactive_flips;
  json["background_difference"] = result.background_difference;
  if (common.talks()) {
    print(fmt::format("{}: {} samples in either band, voxel {:.6g}\n", names(),
                      with_commas(result.samples.total()), first.grid.transform.voxel_size));
    print(fmt::format("mean error {:.6g}, rms error {:.6g} voxels\n", result.mean, result.rms));
    if (result.max > 0)
      print(fmt::format("max error {:.6g} voxels at sample ({}, {}, {}), position ({:.6g}, {:.6g}, {:.6g})\n",
                        result.max, result.max_at.x, result.max_at.y, result.max_at.z, result.max_position.x,
                        result.max_position.y, result.max_position.z));
    print(fmt::format(
        "active in the first only {}, in the second only {}; sign flips in the band {}, beyond {}\n",
        with_commas(result.only_in_a), with_commas(result.only_in_b), with_commas(result.sign_flips),
        with_commas(result.inactive_flips)));
    print(counts_text(result.samples, limits, "samples"));
  }
  summary = fmt::format("{} of {} samples differ by more than {:.6g} voxels, at most by {:.6g}",
                        with_commas(result.samples.failed()), with_commas(result.samples.total()),
                        limits.fail, result.max);
  if (result.samples.verdict() != Verdict::failure && result.verdict == Verdict::failure)
    summary = fmt::format("the backgrounds differ by {:.6g} voxels", result.background_difference);
  return result.verdict;
}

void Compare::run() {
  const Thresholds limits = resolve();
  b.grid = a.grid;
  b.trust_input = a.trust_input;
  b.max_memory = a.max_memory;
  const Kind kind = kind_of(a.path);
  if (kind_of(b.path) != kind)
    throw Error(ErrorKind::usage, names() + ": a .vdb cannot be compared with an .exr");
  if (kind == Kind::exr && !a.grid.empty())
    throw Error(ErrorKind::usage, "--grid: is for .vdb files; pictures have none");
  std::vector<std::string> outputs;
  if (!diff.empty()) {
    check_output(diff, a.path, {".exr", ".png"}, outputs);
    outputs.clear();
    check_output(diff, b.path, {".exr", ".png"}, outputs);
  }
  if (!common.json.empty() && common.json != "-") check_output(common.json, a.path, {}, outputs);

  const ThreadLimit threads(common.threads);
  Json json{{"a", a.path}, {"b", b.path}, {"type", kind == Kind::exr ? "exr" : "vdb"}, {"verdict", ""}};
  for (const ThresholdOption& option : thresholds) // what is infinite is no limit: null
    json["options"][option.name + 2] = number_json(limits.*option.value);
  json["options"]["allowfailures"] = allow_failures;
  json["options"]["nan_fail"] = nan_fail;
  json["options"]["grid"] = a.grid;
  json["options"]["diff"] = diff;
  std::string summary;
  const Verdict verdict =
      kind == Kind::exr ? compare_exr(limits, json, summary) : compare_vdb(limits, json, summary);
  json["verdict"] = name_of(verdict);
  write_json(common, json);
  if (verdict == Verdict::failure) throw Error(ErrorKind::mismatch, names() + ": " + summary);
  if (verdict == Verdict::warning) print_warning(names() + ": they differ, within the limits of failure");
}

} // namespace

void add_compare(CLI::App& program, Work& run) {
  auto options = std::make_shared<Compare>();
  CLI::App& command = *program.add_subcommand("compare", "Tell how much two pictures or level sets differ");
  command.footer(R"(Examples:
  levelray compare a.exr b.exr
  levelray compare a.exr b.exr --fail 0.004 --failpercent 0.1 --hardfail 0.25 --diff difference.png
  levelray compare a.vdb b.vdb --fail 0.01

Exit code 0: the same within the thresholds, which have the names, meanings and defaults of OpenImageIO's idiff;
6: they differ. A pixel differs by the largest difference of its channels; where data windows do not overlap, the
missing pixels count as 0. A sample of a .vdb differs by voxels; those active in either file are compared.)");
  command.add_option("A", options->a.path, "An .exr or a .vdb")->required();
  command.add_option("B", options->b.path, "Another of the same kind")->required();
  const std::string group = "Comparison";
  for (ThresholdOption& option : options->thresholds)
    command.add_option(option.name, option.text, option.help)
        ->capture_default_str()
        ->type_name("NUMBER")
        ->group(group);
  command
      .add_option("--allowfailures", options->allow_failures,
                  "So many pixels or samples may differ by any amount")
      ->capture_default_str()
      ->check(CLI::Range(std::uint64_t{0}, std::uint64_t{1} << 62))
      ->type_name("N")
      ->group(group);
  command.add_flag("--nan-fail", options->nan_fail, "NaN differs from NaN")->group(group);
  command
      .add_option(
          "--diff", options->diff,
          "Write the difference: .exr: A - B in every channel; .png: in false colours, black none, grey "
          "up to --fail, red to white more, magenta not finite")
      ->type_name("FILE")
      ->group(group);
  const std::string input = "Input";
  command.add_option("--grid", options->a.grid, "Grid of both .vdb: NAME, NAME[i], or [i]")
      ->type_name("NAME")
      ->group(input);
  command
      .add_flag("--trust-input", options->a.trust_input,
                "Read the files in this process instead of a limited one of their own")
      ->group(input);
  command
      .add_option(
          "--max-memory", options->a.max_memory,
          "Refuse files that need more, e.g. 8GiB (exit 5); 0: no limit; default: 80% of the machine's "
          "memory")
      ->type_name("SIZE")
      ->group(input);
  options->common.add_to(command);
  command.callback([options, &run] { run = [options] { options->run(); }; });
}

} // namespace levelray
