// levelray farm: jobs for other people's queues. There is no engine of our own.
#include "commands.hpp"
#include "console.hpp"
#include "framing.hpp"
#include "job_script.hpp"
#include "levelray/core/error.hpp"
#include "levelray/io/frame_list.hpp"
#include "levelray/io/output_file.hpp"
#include "names.hpp"
#include "options.hpp"

#include <algorithm>
#include <climits>
#include <filesystem>
#include <fmt/format.h>
#include <memory>
#include <unistd.h>

namespace levelray {

namespace {

namespace fs = std::filesystem;

struct Farm {
  std::string kind, frames, output, program, name;
  int chunk = 10;
  std::string scene;
  std::vector<std::string> farmed, directives;

  void run() const;
  std::vector<std::string> render_command() const;
};

// The path of this very program.
std::string own_path() {
  char buffer[PATH_MAX];
  const ssize_t length = ::readlink("/proc/self/exe", buffer, sizeof buffer);
  if (length <= 0) throw Error(ErrorKind::failed, "cannot tell where this program is; give --program");
  return std::string(buffer, static_cast<std::size_t>(length));
}

bool has_option(const std::vector<std::string>& words, const std::string& name) {
  return std::any_of(words.begin(), words.end(),
                     [&](const std::string& word) { return word == name || word.starts_with(name + "="); });
}

// Whether what is rendered is a scene.
bool names_scene(const std::vector<std::string>& words) {
  for (std::size_t i = 0; i < words.size(); ++i)
    if (!words[i].starts_with("-") && extension_of(words[i]) == ".json" &&
        (i == 0 || words[i - 1] != "--json"))
      return true;
  return false;
}

// "shot.json", "shot.json -o x", or "render ...", whose "render" a file of that name would be written
// ./render.
std::vector<std::string> Farm::render_command() const {
  std::vector<std::string> words = farmed;
  if (!scene.empty() && !words.empty() && words.front() == "render")
    throw Error(ErrorKind::usage,
                "two things to render: " + printable(scene, 200) + ", and a command after --");
  if (!scene.empty()) words.insert(words.begin(), scene);
  if (words.empty())
    throw Error(
        ErrorKind::usage,
        "nothing to render; give a scene, or after -- a command: levelray farm slurm -f 1-100 -- render "
        "'in.####.vdb' -o 'out.####.exr'");
  std::vector<std::string> command{program.empty() ? own_path() : program};
  if (words.front() != "render") command.push_back("render");
  command.insert(command.end(), words.begin(), words.end());
  if (command.size() < 3) throw Error(ErrorKind::usage, "nothing to render after \"render\"");
  for (const char* own : {"-f", "--frames", "--skip-existing"})
    if (has_option(words, own))
      throw Error(ErrorKind::usage, fmt::format("{} stands before --, once for all tasks", own));
  // Without a scene, camera and ground may be placed by what frames hold: for every task by the whole job's.
  if (!names_scene(words) && !has_option(words, "--camera-frames"))
    command.push_back(
        fmt::format("--camera-frames={}", fmt::join(framing_frames(parse_frames("--frames", frames)), ",")));
  return command;
}

void Farm::run() const {
  const std::size_t which = find_name("KIND", kind, {"slurm", "parallel"});
  if (which != 0 && !directives.empty()) throw Error(ErrorKind::usage, "--sbatch: is for slurm");
  for (const std::string& directive : directives)
    if (!directive.starts_with("-") || directive.find('\n') != std::string::npos)
      throw Error(ErrorKind::usage,
                  fmt::format("--sbatch \"{}\": must be an option of sbatch, e.g. --sbatch=--mem=8G",
                              printable(directive, 100)));
  FarmJob job;
  job.command = render_command();
  const std::vector<int> list = parse_frames("--frames", frames);
  job.frames = list.size();
  job.chunks = frame_chunks(list, static_cast<std::size_t>(chunk));
  job.folder = fs::current_path().string();
  job.name = name.empty() ? fs::path(job.command[2]).stem().string() : name;
  job.directives = directives;
  job.creator = "levelray " LEVELRAY_VERSION;
  const std::string script = which == 0 ? slurm_script(job) : parallel_script(job);
  // Slurm's default MaxArraySize is 1001: indices up to 1000.
  if (which == 0 && job.chunks.size() > 1001)
    print_warning(
        fmt::format("{} tasks: most Slurm clusters allow 1,001 (MaxArraySize); take a larger --chunk",
                    with_commas(job.chunks.size())));
  if (output.empty()) return print(script);
  std::vector<std::string> outputs;
  check_output(output, job.command[2], {}, outputs);
  write_file_atomically(output, [&](const std::string& temporary) {
    write_file_atomically(temporary, script);
    if (fs::is_regular_file(temporary))
      fs::permissions(temporary, fs::perms::owner_exec | fs::perms::group_exec | fs::perms::others_exec,
                      fs::perm_options::add);
  });
  print(fmt::format("wrote {}: {} in {}\n", printable(output, 300), counted(job.frames, "frame", "frames"),
                    counted(job.chunks.size(), "task", "tasks")));
}

} // namespace

void add_farm(CLI::App& program, Work& run, const std::vector<std::string>& farmed) {
  auto options = std::make_shared<Farm>();
  options->farmed = farmed;
  CLI::App& command =
      *program.add_subcommand("farm", "Write a job script that renders frames on many machines");
  command.footer(R"(Examples:
  levelray farm slurm shot.json -f 1-1000 --chunk 10 -o job.sh && sbatch job.sh
  levelray farm slurm -f 1-1000 --sbatch=--mem=8G -o job.sh -- render 'cache/x.####.vdb' -o 'out/x.####.exr'
  levelray farm parallel shot.json -f 1-100 -o job.sh && ./job.sh

Every task renders some frames with --skip-existing, in the folder that this is called in. Tasks may run twice, or
at the same time: outputs appear whole, and are the same bytes.)");
  command
      .add_option("KIND", options->kind,
                  "slurm: a job array for sbatch; parallel: a script around GNU parallel")
      ->required();
  command
      .add_option(
          "SCENE", options->scene,
          "A scene, more options for which may follow after --; or nothing, and after -- \"render\" with "
          "all its options but frames")
      ->type_name("TEXT");
  command.add_option("--frames,-f", options->frames, "Frames, as render takes them: 1-100, 1-100x2, 1,5,9")
      ->type_name("LIST")
      ->required();
  command.add_option("--chunk", options->chunk, "Frames of a task")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000000))
      ->type_name("N");
  command.add_option("--output,-o", options->output, "Write the script here instead of standard output")
      ->type_name("FILE");
  command
      .add_option("--program", options->program,
                  "Where levelray is on the other machines; default: the path of this one")
      ->type_name("PATH");
  command.add_option("--name", options->name, "The job's name; default: that of the scene")
      ->type_name("NAME");
  command
      .add_option("--sbatch", options->directives,
                  "An option of sbatch to write into the script, e.g. --sbatch=--mem=8G; repeatable")
      ->type_name("OPTION")
      ->allow_extra_args(false);
  command.callback([options, &run] { run = [options] { options->run(); }; });
}

} // namespace levelray
