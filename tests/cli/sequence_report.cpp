#include "sequence_report.hpp"

#include "support/catch.hpp"
#include "support/sequence_job.hpp"

#include <cerrno>
#include <cstring>
#include <pty.h>

using namespace levelray;
using namespace levelray::test;

TEST_CASE("progress of a sequence tells frames, share, rate and the time that is left") {
  CHECK(sequence_progress_text(0, 0, 100, 0) == "frame 1/100  0%");
  // Half of the first frame took 2 s: 4 s each, 99.5 of them to go.
  CHECK(sequence_progress_text(0, 0.5, 100, 2) == "frame 1/100  0%  15 frames/min  6:38 left");
  // 20 frames were there before; 22.5 frames of work took 30 s.
  CHECK(sequence_progress_text(42, 22.5, 100, 30) == "frame 43/100  42%  45 frames/min  1:17 left");
  CHECK(sequence_progress_text(100, 100, 100, 60) == "frame 100/100  100%  100 frames/min  0.00 s left");
}

TEST_CASE("a sequence shows its progress on a terminal only, and wipes it") {
  const TemporaryFolder folder;
  write_text(folder / "box.obj", box_obj(3, 2, 1));
  const Arguments job{
      "render", folder / "box.obj", "--turntable", "60", "-o", folder / "x.###.exr", "--resolution",
      "30",     "--size",           "160x120"};
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
  CHECK(run_program(job, options).code == 0);
  ::close(slave);
  std::string shown;
  char piece[4096];
  for (ssize_t size; (size = ::read(master, piece, sizeof piece)) > 0;)
    shown.append(piece, static_cast<std::size_t>(size));
  ::close(master);
  CHECK_THAT(shown, Catch::Contains("/60  ") && Catch::Contains(" frames/min  ") && Catch::Contains(" left"));
  CHECK_THAT(shown, Catch::EndsWith("\r\033[K"));
}
