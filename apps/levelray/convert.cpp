// levelray convert: a mesh to an OpenVDB level set.
#include "commands.hpp"
#include "input.hpp"
#include "levelray/core/error.hpp"
#include "levelray/core/parallel.hpp"
#include "levelray/io/output_file.hpp"
#include "mesh_frames.hpp"
#include "tolerance.hpp"

#include <filesystem>
#include <fmt/format.h>
#include <memory>

namespace levelray {

namespace {

struct Convert {
  CommonOptions common;
  InputOptions input;
  ConversionOptions conversion;
  SequenceOptions sequence;
  ToleranceOption tolerance;
  std::string output;
  bool half = false;

  void run(const CLI::App& command) const;

 private:
  void run_one(const CLI::App& command, VdbWriteOptions options) const;
  void run_frames(const FramePlan& plan, const VdbWriteOptions& options) const;
};

void Convert::run(const CLI::App& command) const {
  const FramePlan plan = plan_frames(sequence, {1}, {input.path}, {output}, {".vdb"});
  VdbWriteOptions options;
  options.half = half;
  options.creator = "levelray " LEVELRAY_VERSION;
  std::vector<std::string> outputs;
  if (!common.json.empty() && common.json != "-") check_output(common.json, input.path, {}, outputs);
  if (!plan.numbered && !sequence.skip_existing) return run_one(command, options);
  if (tolerance.asked())
    throw Error(ErrorKind::usage,
                "--tolerance is for one mesh; choose for one frame of the sequence, and give the "
                "others the --voxel that it takes");
  run_frames(plan, options);
}

void Convert::run_frames(const FramePlan& plan, const VdbWriteOptions& options) const {
  conversion.check();
  parse_unit(input.units);
  const ThreadLimit threads(common.threads);
  const MeshFrames source(input, conversion, options);
  SequenceReport report(common, source.verb(), plan.frames.size());
  Sequence(plan, sequence, input.memory_limit()).run(source, report);
  Json all_options = input.json();
  all_options.update(conversion.json());
  all_options.update(sequence.json());
  report.finish({{"options", all_options}});
}

void Convert::run_one(const CLI::App& command, VdbWriteOptions options) const {
  conversion.check();
  const ThreadLimit threads(common.threads);
  const Stopwatch total;
  Progress progress(common.quiet);
  std::optional<TolerableGrid> tolerable;
  if (tolerance.asked())
    tolerable = load_to_tolerance(tolerance, ToleranceLimits::of_convert(command, half), input, conversion,
                                  common, progress);
  const LoadedGrid loaded =
      tolerable            ? std::move(tolerable->loaded)
      : is_vdb(input.path) ? load_grid(input, conversion, common, progress)
                           : convert_mesh(input, conversion, common, progress, [](const ConvertPlan& plan) {
                               check_vdb_voxel_size(plan.voxel_size);
                             });
  if (tolerable) options.half = tolerable->chosen.half;

  const Stopwatch write;
  write_file_atomically(output, [&](const std::string& path) { write_vdb(path, loaded.grid, options); });
  const double write_ms = write.ms();

  if (common.talks())
    print(fmt::format("wrote {}: grid \"{}\", {} active samples, {}, {}\n", printable(output, 300),
                      loaded.grid.name, with_commas(loaded.grid.active_sample_count()),
                      bytes_text(std::filesystem::file_size(output)), duration_text(total.ms() / 1000)));
  Json json = Json::object(), ms = {{"read", loaded.read_ms}};
  if (loaded.converted) {
    const ConvertReport& report = *loaded.converted;
    json["input"] = mesh_json(*loaded.mesh);
    json["sign"] = {{"method", sign_method_names()[static_cast<std::size_t>(report.sign)]},
                    {"reason", report.sign_reason}};
    ms["distance"] = report.distance_ms;
    ms["sign"] = report.sign_ms;
  }
  ms["write"] = write_ms;
  ms["total"] = total.ms();
  json["grid"] = grid_json(loaded.grid);
  if (tolerable) json["tolerance"] = tolerable->json;
  json["ms"] = ms;
  json["warnings"] = loaded.warnings;
  add_field_facts(json, loaded);
  write_json(common, json);
}

} // namespace

void add_convert(CLI::App& program, Work& run) {
  auto options = std::make_shared<Convert>();
  CLI::App& command =
      *program.add_subcommand("convert", "Convert a mesh, or a foreign .vdb, to an OpenVDB level set");
  command.footer(R"(Examples:
  levelray convert statue.ply statue.vdb
  levelray convert statue.ply statue.vdb --resolution 1024
  levelray convert part.stl part.vdb --units mm --voxel 0.5mm --band 4vx
  levelray convert scan.obj scan.vdb --sign winding --json report.json
  levelray convert part.stl part.vdb --units mm --tolerance 0.05mm
  levelray convert flag.ply flag.vdb --thicken 1.5vx
  levelray convert fluid_data_0042.vdb liquid.vdb --grid phi
  levelray convert 'cloth.####.obj' 'cloth.####.vdb' -f 1-100 --skip-existing

Converts a mesh (OBJ, PLY, STL, OFF) to an OpenVDB level set: exact distances within a narrow band. Of a .vdb it takes one
level set, and makes distances of its values where they are none (--redistance).)");
  command
      .add_option("IN", options->input.path, "A mesh or a .vdb; -: a mesh on standard input (needs --format)")
      ->required();
  command.add_option("OUT", options->output, "The .vdb to write")->required();
  options->conversion.add_to(command);
  options->tolerance.add_to(command, false);
  command.add_flag("--half", options->half, "Store 16-bit floats: half the size, values to 11 bits")
      ->group("Conversion");
  options->sequence.add_to(command);
  options->input.add_to(command);
  options->common.add_to(command);
  command.callback([options, &run, &command] { run = [options, &command] { options->run(command); }; });
}

} // namespace levelray
