// The subcommands. Each adds itself to the program and, when it was chosen, sets `run` to the work that is to
// be done; errors leave it as exceptions.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

namespace levelray {

using Work = std::function<void()>;

void add_convert(CLI::App& program, Work& run);
void add_render(CLI::App& program, Work& run);
void add_info(CLI::App& program, Work& run);
void add_compare(CLI::App& program, Work& run);
// `farmed`: the command line behind "--".
void add_farm(CLI::App& program, Work& run, const std::vector<std::string>& farmed);
void add_scene(CLI::App& program, Work& run);
// `command_line`: the whole of it, for the report.
void add_measure(CLI::App& program, Work& run, const std::vector<std::string>& command_line);

} // namespace levelray
