// levelray measure: suites of measurements, as text, JSON and a page.
#include "commands.hpp"
#include "input.hpp"
#include "levelray/core/error.hpp"
#include "levelray/core/parallel.hpp"
#include "levelray/io/output_file.hpp"
#include "machine.hpp"
#include "measure_document.hpp"
#include "measure_suites.hpp"
#include "names.hpp"

#include <fmt/format.h>
#include <memory>

namespace levelray {

std::vector<int> parse_counts(const std::string& option, const std::string& text, int least, int most) {
  std::vector<int> counts;
  for (const std::string& piece : split_list(text)) {
    double value = 0;
    std::string_view rest;
    if (!parse_number(piece, &value, &rest) || !rest.empty() || !(value >= least && value <= most) ||
        value != static_cast<int>(value))
      throw Error(ErrorKind::usage, fmt::format("{} \"{}\": must be whole numbers from {} to {}, like 32,64",
                                                option, printable(text, 80), least, most));
    counts.push_back(static_cast<int>(value));
  }
  return counts;
}

double band_voxels(const MeasureOptions& options) {
  const Length band = parse_length("--band", options.band);
  if (band.unit != Length::Unit::voxels || !(band.value >= 1 && band.value <= 64))
    throw Error(ErrorKind::usage, "--band \"" + printable(options.band, 80) + "\": must be 1vx to 64vx");
  return band.value;
}

namespace {

std::vector<std::string> suite_names() {
  std::vector<std::string> names;
  for (const MeasureSuite& suite : measure_suites()) names.push_back(suite.name);
  return names;
}

// The command line so that a shell reads it back.
std::string shell_text(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) {
    text += text.empty() ? "" : " ";
    const bool plain =
        !word.empty() && word.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                                                "0123456789_-+=,./:@%") == std::string::npos;
    if (plain) {
      text += word;
      continue;
    }
    text += '\'';
    for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
    text += '\'';
  }
  return text;
}

void measure(const MeasureOptions& options, const std::vector<std::string>& command_line) {
  const bool own = !options.input.path.empty();
  if (own == !options.suite.empty())
    throw Error(ErrorKind::usage, "measure takes a mesh, a .vdb or --suite: " + join(suite_names()));
  const MeasureSuite suite = !own ? measure_suites()[find_name("--suite", options.suite, suite_names())]
                             : is_vdb(options.input.path) ? MeasureSuite{"grid", "", measure_grid}
                                                          : MeasureSuite{"mesh", "", measure_mesh};
  std::vector<std::string> outputs;
  if (!options.common.json.empty() && options.common.json != "-")
    check_output(options.common.json, options.input.path, {}, outputs);
  if (!options.report.empty()) check_output(options.report, options.input.path, {".html", ".htm"}, outputs);

  const ThreadLimit threads(options.common.threads);
  Progress progress(options.common.quiet);
  const Stopwatch watch;
  Json document = {{"title", "levelray measure"},
                   {"suite", suite.name},
                   {"command", shell_text(command_line)},
                   {"version", LEVELRAY_VERSION},
                   {"machine", machine_json()},
                   {"options", Json::object()},
                   {"seconds", 0.0},
                   {"failures", Json::array()},
                   {"findings", Json::array()},
                   {"notes", Json::array()},
                   {"sections", Json::array()}};
  suite.run(options, progress, document);
  progress.finish();
  document["seconds"] = watch.ms() / 1000;

  if (options.common.talks()) print(document_text(document));
  if (!options.report.empty()) write_file_atomically(options.report, document_page(document));
  write_json(options.common, document);
  if (!document["failures"].empty())
    throw Error(ErrorKind::mismatch, fmt::format("{}: {}: {}", suite.name,
                                                 counted(document["failures"].size(), "failure", "failures"),
                                                 document["failures"][0].get<std::string>()));
}

} // namespace

void add_measure(CLI::App& program, Work& run, const std::vector<std::string>& command_line) {
  auto options = std::make_shared<MeasureOptions>();
  CLI::App& command =
      *program.add_subcommand("measure", "Measure what methods lose, how exact and how fast they are");
  command.footer(R"(Examples:
  levelray measure statue.ply --report statue.html
  levelray measure statue.vdb
  levelray measure --suite analytic --report accuracy.html
  levelray measure --suite analytic --resolution 64,128,256,512 --shapes sphere,torus --json accuracy.json
  levelray measure --suite paper --models stanford --repeat 7 --report tables.html

Of a mesh: how far its level sets are from it, where it is too thin for them, and what each method gives and costs.
Of a level set: whether it is a distance, where it is too thin, what is proven about hits, and what each method gives and costs.
Of a suite: every method by every shape and resolution: rays that leak, meet phantoms or wrong surfaces, errors of hits and
normals, how they shrink with the voxels, times and work. The report is one page that needs no network. Ends with 6
where a promise is broken: exact hits that are wrong, accelerations that change an answer, extremes that are red.)");
  std::string suites;
  for (const MeasureSuite& suite : measure_suites())
    suites += fmt::format("{}{}: {}", suites.empty() ? "" : "; ", suite.name, suite.help);
  command.add_option("IN", options->input.path, "A mesh or a .vdb, instead of --suite");
  command.add_option("--suite", options->suite, "What to measure. " + suites)->type_name("NAME");
  command.add_option("--report", options->report, "Write the page to FILE.html")->type_name("FILE");
  command
      .add_option("--resolution,--resolutions", options->resolutions,
                  "Voxels along the longest side of the mesh (64,128,256) or model (128,256,512), or along a "
                  "length of 1, "
                  "which shapes have about (32,64,128,256)")
      ->type_name("LIST");
  command.add_option("--shapes", options->shapes, "Of these shapes only")->type_name("LIST");
  command
      .add_option("--models", options->models,
                  "The suite paper: look for its bunny, dragon and buddha in this folder and below it")
      ->type_name("DIR");
  command.add_option("--size", options->size, "The suite paper: pixels along each side of its pictures")
      ->check(CLI::Range(16, 4096))
      ->capture_default_str();
  command.add_option("--band", options->band, "Half-width of the band, in voxels")
      ->type_name("Nvx")
      ->capture_default_str();
  command
      .add_option(
          "--rays", options->rays,
          "Random rays per shape; for suites as many, about, pass through the pixels of a square picture")
      ->check(CLI::Range(std::size_t{16}, std::size_t{100'000'000}))
      ->capture_default_str();
  command.add_option("--seed", options->seed, "Of the random rays")->capture_default_str();
  command
      .add_option("--repeat", options->repeat,
                  "Repetitions of timings, of which the median counts; 0: no times")
      ->check(CLI::Range(0, 1000))
      ->capture_default_str();
  options->input.add_to(command);
  options->common.add_to(command);
  command.callback(
      [options, &run, command_line] { run = [options, command_line] { measure(*options, command_line); }; });
}

} // namespace levelray
