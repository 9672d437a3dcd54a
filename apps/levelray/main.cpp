// levelray: meshes to level sets, level sets to pictures. Ends with the exit codes of core/error.hpp, or 128
// + signal.
#include "commands.hpp"
#include "console.hpp"
#include "levelray/core/error.hpp"
#include "levelray/core/parallel.hpp"
#include "levelray/io/exr_writer.hpp"
#include "levelray/io/output_file.hpp"
#include "names.hpp"
#include "signals.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fmt/format.h>
#include <new>
#include <string_view>
#include <unistd.h>

namespace {

using namespace levelray;

std::string version_text() {
  return fmt::format("levelray {}\nOpenVDB {}, OpenEXR {}, oneTBB {}\n", LEVELRAY_VERSION,
                     LEVELRAY_OPENVDB_VERSION, openexr_version(), tbb_version());
}

constexpr const char* examples = R"(Examples:
  levelray convert statue.ply statue.vdb
  levelray render statue.vdb -o statue.png
  levelray info statue.vdb

Turns meshes into sparse signed distance fields, and ray traces them.
"levelray SUBCOMMAND --help" begins with examples, too.)";

std::vector<std::string> option_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

std::vector<std::string> subcommand_names(const CLI::App& program) {
  std::vector<std::string> names;
  for (const CLI::App* command : program.get_subcommands({})) names.push_back(command->get_name());
  return names;
}

// CLI11's complaint in our words: one line that names what was meant.
std::string usage_message(const CLI::App& program, const CLI::ParseError& error) {
  const auto chosen = program.get_subcommands();
  const CLI::App& command = chosen.empty() ? program : *chosen.front();
  const std::string help =
      std::string("; see levelray ") + (chosen.empty() ? "" : command.get_name() + " ") + "--help";
  if (dynamic_cast<const CLI::ExtrasError*>(&error)) {
    const std::vector<std::string> extras = program.remaining(true);
    const std::string typed = extras.empty() ? "" : extras.front().substr(0, extras.front().find('='));
    if (typed.starts_with("-"))
      return "unknown option " + printable(typed, 100) + suggestion(typed, option_names(command)) + help;
    return "unexpected argument \"" + printable(typed, 200) + "\"" + help;
  }
  // "--threads: Value x not in range 0 to 4096", of numbers that are not whole, too.
  const std::string text = error.what(), range = " not in range ";
  const std::size_t value = text.find(": Value "), bounds = text.rfind(range);
  if (value != std::string::npos && bounds != std::string::npos && value < bounds)
    return printable(text.substr(0, value) + text.substr(value + 7, bounds - value - 7) +
                         ": not a whole number from " + text.substr(bounds + range.size()),
                     350) +
           help;
  return printable(text, 350) + help;
}

// The help of the chosen subcommand or, without one, the program: its examples first, which CLI11 keeps as
// the footer.
std::string help_text(CLI::App& program) {
  const auto chosen = program.get_subcommands();
  CLI::App& command = chosen.empty() ? program : *chosen.front();
  const std::string first = command.get_footer();
  command.footer("");
  if (!chosen.empty()) command.description("");
  return first + "\n" + program.help();
}

// Checks the subcommand before CLI11 does, whose complaint does not tell what there is.
void check_subcommand(const CLI::App& program, int argc, char** argv) {
  const std::vector<std::string> names = subcommand_names(program);
  if (argc < 2)
    throw Error(ErrorKind::usage, "a subcommand is missing: " + join(names) + "; see levelray --help");
  const std::string typed = argv[1];
  if (!typed.starts_with("-")) {
    find_name("subcommand", typed, names);
  } else if (const auto own = option_names(program);
             typed != "-h" && std::find(own.begin(), own.end(), typed) == own.end()) {
    throw Error(ErrorKind::usage, "unknown option " + printable(typed, 100) + suggestion(typed, own) +
                                      "; a subcommand comes first: " + join(names));
  }
}

// The command line behind "--" that `farm` puts into scripts; taken off, because CLI11 would read it as its
// own.
std::vector<std::string> take_farmed_command(int& argc, char** argv) {
  if (argc < 2 || std::string_view(argv[1]) != "farm") return {};
  char** const end = argv + argc;
  char** const dashes = std::find(argv, end, std::string_view("--"));
  argc = static_cast<int>(dashes - argv);
  return dashes == end ? std::vector<std::string>() : std::vector<std::string>(dashes + 1, end);
}

void run(int argc, char** argv) {
  const std::vector<std::string> command_line(argv, argv + argc);
  const std::vector<std::string> farmed = take_farmed_command(argc, argv);
  CLI::App program("", "levelray");
  program.footer(examples);
  Work work;
  add_convert(program, work);
  add_render(program, work);
  add_info(program, work);
  add_compare(program, work);
  add_farm(program, work, farmed);
  add_scene(program, work);
  add_measure(program, work, command_line);
  program.require_subcommand(1);
  program.set_version_flag("--version", version_text);
  for (CLI::App* command : program.get_subcommands({})) command->set_version_flag("--version", version_text);

  check_subcommand(program, argc, argv);
  try {
    program.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    return print(help_text(program));
  } catch (const CLI::CallForVersion&) {
    return print(version_text());
  } catch (const CLI::ParseError& error) {
    throw Error(ErrorKind::usage, usage_message(program, error));
  }
  work();
}

// Runs the program and turns every way to fail into a line and an exit code.
int run_to_exit_code(int argc, char** argv) {
  const auto fail = [](ErrorKind kind, const char* message) {
    print_error(message);
    return static_cast<int>(kind);
  };
  try {
    run(argc, argv);
    return 0;
  } catch (const OutputGone&) {
    die_of_broken_pipe();
  } catch (const Error& error) {
    // A limited write or a child that the signal reached may fail before the work itself notices the signal.
    return stop_signal() != 0 ? 128 + stop_signal() : fail(error.kind(), error.what());
  } catch (const std::bad_alloc&) {
    return fail(ErrorKind::limit, "out of memory; try coarser voxels or a smaller picture");
  } catch (const std::exception& error) { // Cancelled, or what nobody expected
    return stop_signal() != 0 ? 128 + stop_signal() : fail(ErrorKind::failed, error.what());
  } catch (...) {
    return fail(ErrorKind::failed, "an unknown error");
  }
}

// Where an exception has no way out, e.g. when there is no memory even to tell about the lack of it.
[[noreturn]] void on_terminate() {
  try {
    if (const std::exception_ptr error = std::current_exception()) std::rethrow_exception(error);
  } catch (const std::bad_alloc&) {
    constexpr std::string_view message = "levelray: out of memory\n";
    [[maybe_unused]] const auto written = ::write(STDERR_FILENO, message.data(), message.size());
    remove_temporary_files();
    ::_exit(static_cast<int>(ErrorKind::limit));
  } catch (...) {
  }
  std::abort();
}

} // namespace

int main(int argc, char** argv) {
  if (reserve_standard_streams()) set_output_closed();
  handle_signals();
  std::set_terminate(on_terminate);
  const int code = run_to_exit_code(argc, argv);
  // Workers that are still busy after a signal must not hold up the end.
  if (stop_signal() != 0) {
    remove_temporary_files();
    std::fflush(stderr);
    ::_exit(code);
  }
  return code;
}
