// levelray farm: scripts that a shell reads as they were meant. That Slurm runs them is seen in tests/jobs.
#include "job_script.hpp"
#include "support/catch.hpp"
#include "support/mesh_files.hpp"
#include "support/read_output.hpp"
#include "support/run_program.hpp"
#include "support/temporary_folder.hpp"

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <sys/stat.h>

using namespace levelray;
using namespace levelray::test;

namespace {

// What a shell command prints, and its exit status.
std::pair<std::string, int> shell(const std::string& command) {
  std::FILE* pipe = ::popen(command.c_str(), "r");
  REQUIRE(pipe);
  std::string out;
  char bytes[4096];
  for (std::size_t n; (n = std::fread(bytes, 1, sizeof bytes, pipe)) > 0;) out.append(bytes, n);
  return {out, WEXITSTATUS(::pclose(pipe))};
}

// A program in levelray's place that prints its folder and arguments, one per line.
std::string echoing_program(const TemporaryFolder& folder) {
  const std::string path = folder / "echo arguments";
  write_text(path, "#!/bin/sh\necho \"in $(pwd)\"\nprintf '<%s>\\n' \"$@\"\nexit 4\n");
  std::filesystem::permissions(path, std::filesystem::perms::owner_all);
  return path;
}

FarmJob sample_job() {
  FarmJob job;
  job.command = {"levelray", "render", "shot.json"};
  job.folder = "/";
  job.name = "shot";
  job.chunks = {"1-2", "3"};
  job.frames = 3;
  job.creator = "levelray 0";
  return job;
}

} // namespace

TEST_CASE("a shell reads quoted words back, whatever is in them") {
  for (const std::string word : {"plain-1.2/x", "", "two words", "it's", "\"", "$HOME `id` $(id) \\", "a\nb",
                                 "-n", "*?[a]", "~", "#", ";&|<>(){}!", "caf\xC3\xA9"}) {
    CAPTURE(word);
    CHECK(shell("printf %s " + shell_quoted(word)).first == word);
    CHECK(shell("bash -c " + shell_quoted("printf %s " + shell_quoted(word))).first == word);
  }
}

TEST_CASE("frames are cut into lists for -f") {
  CHECK(frame_chunks({1, 2, 3, 4, 5}, 2) == std::vector<std::string>{"1-2", "3-4", "5"});
  CHECK(frame_chunks({1, 2, 3}, 10) == std::vector<std::string>{"1-3"});
  CHECK(frame_chunks({-3, -2, -1}, 3) == std::vector<std::string>{"-3--1"});
  CHECK(frame_chunks({10, 20, 30, 31, 5}, 5) == std::vector<std::string>{"5,10-30x10,31"});
}

TEST_CASE("a task of the Slurm script runs its chunk, in the folder, with every argument whole") {
  const TemporaryFolder folder;
  FarmJob job = sample_job();
  job.command = {echoing_program(folder), "render", "it's a \"$x\".####.vdb", "-o", "out put/*.####.exr"};
  job.folder = folder / "a 'folder'";
  job.name = "it's a\n#SBATCH --evil";
  job.directives = {"--mem=8G"};
  std::filesystem::create_directory(job.folder);
  write_text(folder / "job.sh", slurm_script(job));
  const auto [out, code] = shell("SLURM_ARRAY_TASK_ID=1 bash " + shell_quoted(folder / "job.sh"));
  CHECK(code == 4); // the program's
  CHECK(out == "in " + job.folder +
                   "\n<render>\n<it's a \"$x\".####.vdb>\n<-o>\n<out "
                   "put/*.####.exr>\n<--frames=3>\n<--skip-existing>\n");
  const std::string cpus =
      "SLURM_CPUS_PER_TASK=3 SLURM_ARRAY_TASK_ID=0 bash " + shell_quoted(folder / "job.sh");
  CHECK_THAT(shell(cpus).first, Catch::EndsWith("<--frames=1-2>\n<--skip-existing>\n<--threads=3>\n"));
  CHECK(shell("bash " + shell_quoted(folder / "job.sh") + " 2>&1").second != 0); // not from Slurm
  CHECK(shell("SLURM_ARRAY_TASK_ID=2 bash " + shell_quoted(folder / "job.sh") + " 2>&1").second != 0);
  job.command.push_back("-j4");
  write_text(folder / "job.sh", slurm_script(job));
  CHECK_THAT(shell(cpus).first, !Catch::Contains("--threads"));

  const std::string script = slurm_script(job);
  CHECK_THAT(script, Catch::StartsWith("#!/bin/bash\n") && Catch::Contains("\n#SBATCH --array=0-1\n") &&
                         Catch::Contains("\n#SBATCH --requeue\n") &&
                         Catch::Contains("\n#SBATCH --mem=8G\n") &&
                         Catch::Contains("\n#SBATCH --job-name=it_s_a__SBATCH_--evil\n"));
}

TEST_CASE("GNU parallel runs every chunk once, with every argument whole") {
  if (shell("command -v parallel").second != 0) {
    WARN("skipped: GNU parallel is not installed (scripts/setup test)");
    return;
  }
  const TemporaryFolder folder;
  FarmJob job = sample_job();
  job.command = {echoing_program(folder), "render", "it's {} {.} \"$x\".####.vdb"};
  job.folder = folder.path();
  write_text(folder / "job.sh", parallel_script(job));
  const auto [out, code] =
      shell("HOME=" + folder.path() + " bash " + shell_quoted(folder / "job.sh") + " --keep-order 2>&1");
  CHECK(code == 2); // both tasks failed
  const auto task = [&](const std::string& frames) {
    return "in " + job.folder + "\n<render>\n<it's {} {.} \"$x\".####.vdb>\n<--frames=" + frames +
           ">\n<--skip-existing>\n";
  };
  CHECK_THAT(out, Catch::EndsWith(task("1-2") + task("3")));
}

TEST_CASE("farm writes a script for a scene and for a whole command, to a file or to standard output") {
  const TemporaryFolder folder;
  const RunResult result =
      run_program({"farm", "slurm", "shot.json", "-f", "1-20", "--chunk", "8", "-o", folder / "job.sh"});
  CHECK(result.code == 0);
  CHECK(result.out == "wrote " + (folder / "job.sh") + ": 20 frames in 3 tasks\n");
  const std::string script = content_of(folder / "job.sh");
  CHECK_THAT(script, Catch::Contains("  1-8\n  9-16\n  17-20\n") &&
                         Catch::Contains(" render shot.json --frames=") &&
                         !Catch::Contains("--camera-frames") && Catch::Contains("--job-name=shot\n"));
  struct stat status {};
  REQUIRE(::stat((folder / "job.sh").c_str(), &status) == 0);
  CHECK((status.st_mode & S_IXUSR) != 0);

  const RunResult whole =
      run_program({"farm", "slurm", "-f", "1-4", "--sbatch=--mem=8G", "--sbatch=--time=10", "--program",
                   "/opt/levelray", "--", "render", "a b.####.vdb", "-o", "x.####.exr", "-j", "2"});
  CHECK(whole.code == 0);
  CHECK_THAT(whole.out, Catch::Contains("#SBATCH --mem=8G\n#SBATCH --time=10\n") &&
                            // Otherwise every task would place its camera by its own frames.
                            Catch::Contains("exec /opt/levelray render 'a b.####.vdb' -o 'x.####.exr' -j 2 "
                                            "--camera-frames=1,2,4 --frames="));
  CHECK_THAT(run_program({"farm", "parallel", "shot.json", "-f", "1-4", "--", "--set", "film.samples=4"}).out,
             Catch::Contains(" render shot.json --set film.samples=4 --frames=\"$1\" --skip-existing\n"));
  const RunResult many = run_program({"farm", "slurm", "shot.json", "-f", "1-5000", "--chunk", "1"});
  CHECK(many.code == 0);
  CHECK_THAT(many.err, Catch::Contains("5,000 tasks") && Catch::Contains("MaxArraySize"));
}

TEST_CASE("farm refuses what makes no job") {
  const TemporaryFolder folder;
  struct Row {
    std::vector<std::string> arguments;
    int code;
    std::string says;
  };
  const std::vector<Row> rows{
      {{}, 2, "KIND"},
      {{"slurm", "shot.json"}, 2, "--frames"},
      {{"slrum", "shot.json", "-f", "1"}, 2, "did you mean \"slurm\""},
      {{"slurm", "-f", "1"}, 2, "nothing to render"},
      {{"slurm", "-f", "1", "--", "render"}, 2, "nothing to render"},
      {{"slurm", "shot.json", "-f", "1", "--", "render", "x.vdb"}, 2, "two things to render"},
      {{"slurm", "shot.json", "-f", "9-1"}, 2, "--frames"},
      {{"slurm", "shot.json", "-f", "1", "--chunk", "0"}, 2, "--chunk"},
      {{"slurm", "-f", "1", "--", "render", "shot.json", "-f", "2"}, 2, "-f stands before --"},
      {{"slurm", "-f", "1", "--", "render", "shot.json", "--frames=2"}, 2, "--frames stands before --"},
      {{"slurm", "shot.json", "-f", "1", "--sbatch=mem"}, 2, "must be an option of sbatch"},
      {{"slurm", "shot.json", "-f", "1", "--sbatch=--x\nrm"}, 2, "must be an option of sbatch"},
      {{"parallel", "shot.json", "-f", "1", "--sbatch=--mem=1"}, 2, "is for slurm"},
      {{"slurm", "shot.json", "-f", "1", "-o", folder / "no/job.sh"}, 2, "does not exist"},
      {{"slurm", "shot.json", "-f", "1", "-o", "/dev/full"}, 74, "/dev/full"},
  };
  for (const Row& row : rows) {
    std::vector<std::string> arguments{"farm"};
    arguments.insert(arguments.end(), row.arguments.begin(), row.arguments.end());
    CAPTURE(arguments);
    const RunResult result = run_program(arguments);
    CHECK(result.code == row.code);
    CHECK(result.out.empty());
    CHECK_THAT(result.err, Catch::Contains(row.says));
    CHECK(folder.names().empty());
  }
}

TEST_CASE("the command of the OpenCue job is one that render takes") {
  const std::string job = content_of(LEVELRAY_SOURCE_DIR "/data/jobs/opencue.xml");
  const std::size_t begin = job.find("<cmd>"), end = job.find("</cmd>");
  REQUIRE(end != std::string::npos);
  std::string command = job.substr(begin + 5, end - begin - 5);
  const TemporaryFolder folder;
  write_text(folder / "box.obj", box_obj(3, 2, 1));
  const auto put = [&](const std::string& from, const std::string& to) {
    const std::size_t at = command.find(from);
    REQUIRE(at != std::string::npos);
    command.replace(at, from.size(), to);
  };
  put("levelray ", LEVELRAY_PROGRAM " ");
  put("/shows/testing/shot.json", folder / "box.obj --size 32x24 -o " + (folder / "out.####.exr"));
  put("#FRAME_START#", "11");
  put("#FRAME_END#", "13");
  CHECK(shell(command + " 2>&1").second == 0);
  for (const char* name : {"out.0011.exr", "out.0012.exr", "out.0013.exr"})
    CHECK(std::filesystem::exists(folder / name));
}
