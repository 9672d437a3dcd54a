// Shell scripts that hand a job of many frames to Slurm or GNU parallel.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace levelray {

// What every task runs is `command` --frames=CHUNK --skip-existing, in `folder`.
struct FarmJob {
  std::vector<std::string> command;    // the program, "render", and its arguments without frames
  std::string folder;                  // absolute: where relative paths of the command begin
  std::string name;                    // of the job; other characters than letters, digits, . _ - become _
  std::vector<std::string> chunks;     // lists of frames as -f takes them
  std::size_t frames = 0;              // how many in all
  std::vector<std::string> directives; // more lines of #SBATCH, e.g. "--mem=8G"
  std::string creator;                 // "levelray 1.2.3"
};

// The word as a POSIX shell reads it back, whatever is in it: 'it'\''s'.
std::string shell_quoted(const std::string& word);

// The frames, `size` and `size`, as lists for -f: "1-10", "11-20x2", "1,5,7".
std::vector<std::string> frame_chunks(const std::vector<int>& frames, std::size_t size);

// A job-array script for sbatch: task i renders chunk i. Tasks are requeued when their node fails, which may
// run a frame twice, even at the same time; levelray's outputs are whole and the same bytes both times. A
// task ends with levelray's exit code.
std::string slurm_script(const FarmJob& job);

// A script that runs the chunks through GNU parallel, with more options of parallel as its arguments.
std::string parallel_script(const FarmJob& job);

} // namespace levelray
