// Signals, full disks, closed streams: an exit code that tells, and no half file. The faults are numbered as
// in the fault matrix that this program is held to, 1 to 22; the others are in faults_*.cpp.
#include "support/catch.hpp"
#include "support/mesh_files.hpp"
#include "support/run_program.hpp"
#include "support/temporary_folder.hpp"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <pty.h>
#include <sys/resource.h>
#include <thread>

using namespace levelray::test;

namespace {

using Names = std::vector<std::string>;

} // namespace

TEST_CASE("fault 3: SIGINT and SIGTERM end long work within half a second and leave no file") {
  const TemporaryFolder folder;
  write_text(folder / "ball.obj", ball_obj(60));
  const std::vector<std::vector<std::string>> jobs{
      {"convert", folder / "ball.obj", folder / "out.vdb", "--resolution", "4096", "--max-memory", "0"},
      {"render", folder / "ball.obj", "-o", folder / "out.png", "--size", "4096x4096", "--samples", "1024",
       "--shadows", "--max-memory", "0"}};
  for (const auto& job : jobs)
    for (const int signal : {SIGINT, SIGTERM})
      for (const double after : {0.05, 0.7}) {
        INFO(job[0] << " signal " << signal << " after " << after);
        RunOptions options;
        options.signals = {{after, signal}};
        const RunResult result = run_program(job, options);
        CHECK(result.code == 128 + signal);
        // A signal that comes while the program is still being loaded ends it as it ends any program, which a
        // shell shows as the same code.
        if (after > 0.5) CHECK_FALSE(result.signalled);
        CHECK(result.seconds_after_signal < promised_seconds);
        CHECK(folder.names() == Names{"ball.obj"});
      }
}

TEST_CASE("fault 3: a second SIGINT ends at once") {
  const TemporaryFolder folder;
  write_text(folder / "ball.obj", ball_obj(60));
  RunOptions options;
  options.signals = {{0.7, SIGINT}, {0.701, SIGINT}};
  const RunResult result = run_program({"render", folder / "ball.obj", "-o", folder / "out.png", "--size",
                                        "4096x4096", "--samples", "1024", "--max-memory", "0"},
                                       options);
  CHECK(result.code == 130);
  CHECK(result.seconds_after_signal < promised_seconds);
  CHECK(folder.names() == Names{"ball.obj"});
}

TEST_CASE("fault 18: standard output that is full or closed ends with 74") {
  const TemporaryFolder folder;
  write_text(folder / "box.obj", box_obj(3, 2, 1));
  const std::vector<std::vector<std::string>> jobs{
      {"info", folder / "box.obj"},
      {"info", folder / "box.obj", "--json", "-"},
      {"convert", folder / "box.obj", folder / "box.vdb", "--resolution", "20"},
      {"render", folder / "box.obj", "-o", folder / "box.png", "--resolution", "20", "--size", "9x9",
       "--json", "-"},
      {"--help"},
      {"--version"}};
  for (const auto& job : jobs) {
    INFO(job[0]);
    RunOptions full, closed;
    full.in_child = [] { ::dup2(::open("/dev/full", O_WRONLY), 1); };
    closed.in_child = [] { ::close(1); };
    const RunResult when_full = run_program(job, full), when_closed = run_program(job, closed);
    CHECK(when_full.code == 74);
    CHECK_THAT(when_full.err,
               Catch::Contains("standard output") && Catch::Contains("No space left on device"));
    CHECK(when_closed.code == 74);
    CHECK_THAT(when_closed.err, Catch::Contains("standard output") && Catch::Contains("closed"));
  }
}

TEST_CASE("fault 18: a closed standard stream never becomes part of an output") {
  const TemporaryFolder folder;
  write_text(folder / "box.obj", box_obj(3, 2, 1));
  RunOptions options;
  options.in_child = [] {
    for (const int stream : {0, 1, 2}) ::close(stream);
  };
  const std::vector<std::string> job{"convert", folder / "box.obj", folder / "a.vdb", "--resolution", "20",
                                     "-q"};
  CHECK(run_program(job, options).code == 0);
  CHECK(run_program({"convert", folder / "box.obj", folder / "b.vdb", "--resolution", "20", "-q"}).code == 0);
  CHECK(std::filesystem::file_size(folder / "a.vdb") == std::filesystem::file_size(folder / "b.vdb"));
}

TEST_CASE("fault 4: a reader that goes away ends the program quietly") {
  const TemporaryFolder folder;
  write_text(folder / "box.obj", box_obj(3, 2, 1));
  RunOptions options;
  options.in_child = [] {
    int ends[2];
    if (::pipe(ends) != 0) ::_exit(126);
    ::close(ends[0]);
    ::dup2(ends[1], 1);
  };
  const RunResult result = run_program({"info", folder / "box.obj"}, options);
  CHECK(result.code == 128 + SIGPIPE);
  CHECK(result.err.empty());
}

TEST_CASE("fault 5: a file that cannot grow ends with 74 and leaves the older output") {
  const TemporaryFolder folder;
  write_text(folder / "ball.obj", ball_obj(30));
  RunOptions options;
  options.in_child = [] {
    const rlimit limit{20000, 20000};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  };
  for (const std::string name : {"out.vdb", "out.exr", "out.png"}) {
    write_text(folder / name, "older");
    const std::vector<std::string> job =
        name == "out.vdb"
            ? std::vector<std::string>{"convert", folder / "ball.obj", folder / name}
            : std::vector<std::string>{"render", folder / "ball.obj", "-o",     folder / name, "--resolution",
                                       "60",     "--ground",          "--size", "400x400"};
    const RunResult result = run_program(job, options);
    INFO(name << ": " << result.err);
    CHECK(result.code == 74);
    CHECK_THAT(result.err, Catch::Contains(folder / name) && Catch::Contains("File too large"));
    CHECK(std::filesystem::file_size(folder / name) == 5);
    std::filesystem::remove(folder / name);
    CHECK(folder.names() == Names{"ball.obj"});
  }
}

TEST_CASE("fault 10: memory that the system refuses ends with 5") {
  const TemporaryFolder folder;
  write_text(folder / "ball.obj", ball_obj(30));
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  WARN("skipped: sanitizers need more address space than any limit leaves");
#else
  RunOptions options;
  options.in_child = [] {
    const rlimit limit{rlim_t{700} << 20, rlim_t{700} << 20};
    ::setrlimit(RLIMIT_AS, &limit);
  };
  const RunResult result = run_program({"render", folder / "ball.obj", "-o", folder / "out.png",
                                        "--resolution", "20", "--size", "20000x20000", "--max-memory", "0"},
                                       options);
  CHECK(result.code == 5);
  CHECK_THAT(result.err, Catch::Contains("out of memory"));
  CHECK(folder.names() == Names{"ball.obj"});
#endif
}

TEST_CASE("progress appears on a terminal only, and is wiped") {
  const TemporaryFolder folder;
  write_text(folder / "ball.obj", ball_obj(30));
  const std::vector<std::string> job{
      "render",  folder / "ball.obj", "-o", folder / "out.png", "--resolution", "40", "--size",
      "500x500", "--samples",         "25"};
  CHECK(run_program(job).err.empty());

  int master = -1, slave = -1;
  if (::openpty(&master, &slave, nullptr, nullptr, nullptr) != 0) {
    WARN("not tested on a terminal: the system gives no pseudo-terminal (" << std::strerror(errno) << ")");
    return;
  }
  RunOptions options;
  options.in_child = [slave] {
    ::setenv("TERM", "xterm", 1);
    ::dup2(slave, 2);
  };
  // A terminal holds back a few pages only: a program that nobody reads from would wait.
  std::string shown;
  std::thread reader([&] {
    char piece[4096];
    for (ssize_t size; (size = ::read(master, piece, sizeof piece)) > 0;)
      shown.append(piece, static_cast<std::size_t>(size));
  });
  CHECK(run_program(job, options).code == 0);
  ::close(slave); // the last one: the reader comes to the end
  reader.join();
  ::close(master);
  CHECK_THAT(shown, Catch::Contains("render") && Catch::Contains("rays/s") && Catch::Contains("left"));
  CHECK_THAT(shown, Catch::EndsWith("\r\033[K"));
}
