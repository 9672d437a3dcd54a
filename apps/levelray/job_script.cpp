#include "job_script.hpp"

#include "console.hpp"
#include "levelray/io/frame_list.hpp"

#include <algorithm>
#include <cctype>
#include <fmt/format.h>

namespace levelray {

namespace {

std::string plain_name(std::string name) {
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '.' && c != '_' && c != '-') c = '_';
  if (name.starts_with("-")) name.front() = '_';
  return name.empty() ? "levelray" : name.substr(0, 100);
}

std::string head(const FarmJob& job, const std::string& how) {
  return fmt::format("#!/bin/bash\n# Renders {} in {}; written by {}. {}\n",
                     counted(job.frames, "frame", "frames"), counted(job.chunks.size(), "task", "tasks"),
                     job.creator, how);
}

std::string frames_array(const FarmJob& job) {
  std::string text = "frames=(\n";
  for (const std::string& chunk : job.chunks) text += "  " + chunk + "\n";
  return text + ")\n";
}

// `frames`: a shell expression of the chunk.
std::string command_line(const FarmJob& job, const std::string& frames, const std::string& more) {
  std::string line = "exec";
  for (const std::string& word : job.command) line += " " + shell_quoted(word);
  return line + " --frames=" + frames + " --skip-existing" + more + "\n";
}

bool chooses_threads(const FarmJob& job) {
  return std::any_of(job.command.begin(), job.command.end(), [](const std::string& word) {
    return word.starts_with("--threads") || (word.starts_with("-j") && !word.starts_with("--"));
  });
}

} // namespace

std::string shell_quoted(const std::string& word) {
  const auto plain = [](unsigned char c) {
    return std::isalnum(c) ||
           std::string_view("_@%+=:,./-").find(static_cast<char>(c)) != std::string_view::npos;
  };
  if (!word.empty() && std::all_of(word.begin(), word.end(), plain)) return word;
  std::string quoted = "'";
  for (const char c : word)
    if (c == '\'')
      quoted += "'\\''";
    else
      quoted += c;
  return quoted + "'";
}

std::vector<std::string> frame_chunks(const std::vector<int>& frames, std::size_t size) {
  std::vector<std::string> chunks;
  for (std::size_t begin = 0; begin < frames.size(); begin += size) {
    std::vector<int> chunk(frames.begin() + static_cast<std::ptrdiff_t>(begin),
                           frames.begin() +
                               static_cast<std::ptrdiff_t>(std::min(begin + size, frames.size())));
    std::sort(chunk.begin(), chunk.end()); // the order within a task is of no matter
    std::string text = frames_text(chunk, std::string::npos);
    text.erase(std::remove(text.begin(), text.end(), ' '), text.end());
    chunks.push_back(text);
  }
  return chunks;
}

std::string slurm_script(const FarmJob& job) {
  std::string text = head(job, "Submit it with sbatch.");
  text += "#SBATCH --job-name=" + plain_name(job.name) + "\n";
  text += fmt::format("#SBATCH --array=0-{}\n", job.chunks.size() - 1);
  text += "#SBATCH --requeue\n#SBATCH --open-mode=append\n";
  for (const std::string& directive : job.directives) text += "#SBATCH " + directive + "\n";
  text += "# A task that is started again, by Slurm or by you, renders only what is missing. It ends with "
          "levelray's\n"
          "# exit code: one with bad frames has failed.\n";
  text += frames_array(job);
  text += "cd -- " + shell_quoted(job.folder) + " || exit 1\n";
  const std::string threads =
      chooses_threads(job) ? "" : " ${SLURM_CPUS_PER_TASK:+--threads=\"$SLURM_CPUS_PER_TASK\"}";
  return text + command_line(job,
                             "\"${frames[${SLURM_ARRAY_TASK_ID:?submit this with sbatch}]:?no such task}\"",
                             threads);
}

std::string parallel_script(const FarmJob& job) {
  std::string text = head(job, "Run it; arguments are options of GNU parallel:");
  text += "#   --jobs 2                  so many tasks at a time on each machine (1 uses all its threads)\n"
          "#   -S host1,host2            on other machines that have the same paths\n"
          "# Run again, it renders only what is missing. Exit code: how many tasks failed.\n";
  text += "render_chunk() {\n  cd -- " + shell_quoted(job.folder) + " || exit 1\n  " +
          command_line(job, "\"$1\"", "") + "}\n";
  text += frames_array(job);
  text +=
      "export -f render_chunk\nexport PARALLEL_SHELL=/bin/bash\n"
      "exec parallel --jobs 1 --line-buffer --env render_chunk \"$@\" render_chunk ::: \"${frames[@]}\"\n";
  return text;
}

} // namespace levelray
