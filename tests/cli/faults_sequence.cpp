// Faults 3, 5 to 9 and 20, of sequences: what has been done stays, and what went wrong is told.
#include "frame_inputs.hpp"
#include "levelray/core/error.hpp"
#include "support/catch.hpp"
#include "support/sequence_job.hpp"

#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <sched.h>
#include <sys/mount.h>
#include <sys/resource.h>

using namespace levelray::test;
namespace fs = std::filesystem;

namespace {

Arguments pictures(const TemporaryFolder& in, const std::string& to, const std::string& frames,
                   const std::string& size = "24x16") {
  return {"render", in / "in.####.obj", "--resolution", "16", "--size", size, "-f", frames,
          "-o",     to + "/x.####.exr"};
}

// Whether this process may mount file systems of its own.
bool may_mount() {
  const pid_t child = ::fork();
  if (child == 0) {
    // A root that is no mount point, as in a chroot, cannot be kept from passing mounts on to others.
    const bool may =
        ::unshare(CLONE_NEWNS) == 0 && ::mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) == 0;
    ::_exit(may ? 0 : 1);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  return status == 0;
}

// Runs the program where `folder` is a tmpfs of its own; the folder's content at the end comes as `left`.
RunResult run_on_tmpfs(const std::string& folder, const std::string& mount_options,
                       const Arguments& arguments, bool read_only, Names& left) {
  const std::string list = folder + ".list";
  // The shell that runs the program is in the same mount name space, and lists what is there after it.
  RunOptions options;
  options.in_child = [=] {
    if (::unshare(CLONE_NEWNS) != 0 || ::mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0 ||
        ::mount("tmpfs", folder.c_str(), "tmpfs", read_only ? MS_RDONLY : 0, mount_options.c_str()) != 0)
      ::_exit(125);
  };
  options.under = {"sh", "-c", "\"$@\"; code=$?; ls -A '" + folder + "' > '" + list + "'; exit $code", "sh"};
  const RunResult result = run_program(arguments, options);
  left.clear();
  std::istringstream names(content_of(list));
  for (std::string name; std::getline(names, name);) left.push_back(name);
  fs::remove(list);
  return result;
}

} // namespace

TEST_CASE(
    "fault 3: signals end a sequence within half a second, with the frames that are done and a summary") {
  const TemporaryFolder folder;
  write_text(folder / "box.obj", box_obj(3, 2, 1));
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    const TemporaryFolder out;
    RunResult result;
    // The signal shall come between frames: later where the program is slow.
    for (double delay = 1.5; count(statuses(result.out), "rendered") == 0 && delay < 30; delay *= 2) {
      RunOptions options;
      options.signals = {{delay, signal}};
      result = run_program({"render", folder / "box.obj", "--turntable", "100000", "-o", out / "x.######.exr",
                            "--resolution", "30", "--size", "100x80", "--json", "-"},
                           options);
    }
    INFO("signal " << signal << ": " << result.err);
    CHECK(result.code == 128 + signal);
    CHECK_FALSE(result.signalled);
    CHECK(result.seconds_after_signal < promised_seconds);
    CHECK_THAT(result.err, Catch::Contains("stopped after ") && Catch::Contains(" of 100,000 frames"));
    const int done = count(statuses(result.out), "rendered");
    CHECK(done > 0);
    // Every line has its file; one more file may have come between the signal and the end.
    const Names names = out.names();
    CHECK((static_cast<int>(names.size()) == done || static_cast<int>(names.size()) == done + 1));
    for (const std::string& name : names) CHECK_FALSE(name.starts_with('.'));
  }
  // While a frame is loading, which is one long conversion here.
  const TemporaryFolder out;
  write_text(folder / "ball.1.obj", ball_obj(60));
  RunOptions options;
  options.signals = {{0.8, SIGINT}};
  const RunResult result = run_program({"convert", folder / "ball.#.obj", out / "x.#.vdb", "-f", "1-1",
                                        "--resolution", "4096", "--max-memory", "0"},
                                       options);
  CHECK(result.code == 130);
  CHECK(result.seconds_after_signal < promised_seconds);
  CHECK(out.names().empty());
}

TEST_CASE(
    "fault 5: a disk that fills up ends a sequence with 74, the earlier frames whole, and nothing half") {
  const TemporaryFolder in, out, whole;
  write_boxes(in, 1, 12);
  CHECK(run_program(pictures(in, whole.path(), "1-12", "160x120")).code == 0);
  const std::size_t size = content_of(whole / "x.0001.exr").size();
  if (!may_mount()) {
    WARN("not tested on a full tmpfs: none can be mounted here");
    return;
  }
  Names left;
  const RunResult result = run_on_tmpfs(out.path(), "size=" + std::to_string(5 * size),
                                        pictures(in, out.path(), "1-12", "160x120"), false, left);
  INFO(result.err << result.out);
  REQUIRE(result.code != 125);
  CHECK(result.code == 74);
  CHECK_THAT(result.err, Catch::Contains(out.path() + "/x.00") && Catch::Contains("No space left on device"));
  CHECK(left.size() >= 2);
  CHECK(left.size() < 12);
  for (std::size_t i = 0; i < left.size(); ++i)
    CHECK(left[i] == whole.names()[i]); // no gap, no temporary file
}

TEST_CASE("fault 5: a file size limit ends a sequence with 74 before its first frame is lost") {
  const TemporaryFolder in, out;
  write_boxes(in, 1, 3);
  RunOptions options;
  options.in_child = [] {
    const rlimit limit{2000, 2000};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  };
  const RunResult result = run_program(pictures(in, out.path(), "1-3", "160x120"), options);
  CHECK(result.code == 74);
  CHECK_THAT(result.err, Catch::Contains("x.0001.exr") && Catch::Contains("File too large"));
  CHECK(out.names().empty());
}

TEST_CASE("fault 6: a folder that cannot be written ends with 74 before any frame is rendered") {
  const TemporaryFolder in, out;
  write_boxes(in, 1, 3);
  fs::permissions(out.path(), fs::perms(0555));
  RunOptions options;
  options.in_child = obey_permissions;
  const RunResult denied = run_program(pictures(in, out.path(), "1-3"), options);
  fs::permissions(out.path(), fs::perms(0755));
  INFO(denied.err);
  CHECK(denied.code == 74);
  CHECK_THAT(denied.err, Catch::Contains(out.path()) && Catch::Contains("Permission denied"));
  CHECK(denied.out.empty());
  if (!may_mount()) {
    WARN("not tested on a read-only file system: none can be mounted here");
    return;
  }
  Names left;
  const RunResult result = run_on_tmpfs(out.path(), "size=1m", pictures(in, out.path(), "1-3"), true, left);
  INFO(result.err);
  CHECK(result.code == 74);
  CHECK_THAT(result.err, Catch::Contains("x.0001.exr") && Catch::Contains("Read-only file system"));
  CHECK(result.out.empty());
}

TEST_CASE("fault 7: failing reads, writes, fsync, close and rename are reported, and leave nothing half") {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  WARN("skipped: sanitizers do not go together with libraries that replace functions");
#else
  const TemporaryFolder in, whole;
  write_boxes(in, 1, 2);
  // A given camera: else it would go by frame 2 where frame 1 cannot be read.
  const auto job = [&](const TemporaryFolder& out) {
    return pictures(in, out.path(), "1-2") + Arguments{"--eye", "3,2,4", "--target", "0.5,0.5,0.25"};
  };
  CHECK(run_program(job(whole)).code == 0);
  for (const std::string call : {"fsync", "rename", "write", "close", "read"}) {
    int reported = 0, unharmed = 0;
    for (int number = 1; number <= 40 && unharmed < 14; ++number) {
      const TemporaryFolder out;
      RunOptions options;
      options.in_child = [&] {
        ::setenv("LD_PRELOAD", LEVELRAY_FAILING_CALLS, 1);
        ::setenv("LEVELRAY_TEST_FAIL", (call + " " + std::to_string(number) + " 5").c_str(), 1); // EIO
      };
      const RunResult result = run_program(job(out), options);
      INFO(call << " " << number << ": " << result.code << " " << result.err);
      // Beyond the last call nothing fails; to close what was only read may fail without harm.
      unharmed = result.code == 0 ? unharmed + 1 : 0;
      reported += result.code != 0;
      CHECK((result.code == 0 || result.code == 74 ||
             (call == "read" && result.code != 139 && result.code != 134)));
      if (result.code == 74)
        CHECK_THAT(result.err,
                   Catch::Contains(".exr: cannot write: ") && Catch::Contains("Input/output error"));
      if (result.code == 0) CHECK((contents(out) == contents(whole)));
      for (const std::string& name : out.names()) CHECK((content_of(out / name) == content_of(whole / name)));
    }
    INFO(call);
    CHECK(reported >= 2);
  }
  // The same by libfiu, as far as it goes: its random failures crash in programs of several threads.
  if (!has_tool("fiu-run")) {
    WARN("not tested with fiu-run: there is none (package fiu-utils)");
    return;
  }
  for (const char* point : {"posix/io/sync/fsync", "posix/io/dir/rename"}) {
    const TemporaryFolder out;
    RunOptions options;
    options.under = {"fiu-run", "-x", "-f", "", "-c", std::string("enable name=") + point + ",failinfo=5"};
    const RunResult result = run_program(pictures(in, out.path(), "1-2"), options);
    INFO(point << ": " << result.err);
    CHECK(result.code == 74);
    CHECK_THAT(result.err, Catch::Contains("x.0001.exr: cannot write: "));
    CHECK(out.names().empty());
  }
#endif
}

TEST_CASE("fault 8: a corrupt frame is reported, the others are rendered, and the exit code is 4") {
  const TemporaryFolder in, whole;
  write_boxes(in, 1, 6);
  CHECK(run_program({"convert", in / "in.####.obj", in / "g.####.vdb", "-f", "1-6", "--resolution", "16"})
            .code == 0);
  const auto job = [&](const TemporaryFolder& out) {
    return Arguments{"render",           in / "g.####.vdb", "-f",    "1-6",    "-o",
                     out / "x.####.exr", "--size",          "24x16", "--json", "-"};
  };
  CHECK(run_program(job(whole)).code == 0);
  fs::resize_file(in / "g.0002.vdb", fs::file_size(in / "g.0002.vdb") / 2);
  write_text(in / "g.0005.vdb", "no level set");
  {
    const TemporaryFolder out;
    const RunResult result = run_program(job(out));
    INFO(result.err);
    CHECK(result.code == 4);
    CHECK_THAT(result.err,
               Catch::Contains("2 of 6 frames failed: 2, 5; first: ") && Catch::Contains("g.0002.vdb"));
    CHECK(count(statuses(result.out), "rendered") == 4);
    CHECK(json_lines(result.out).back()["summary"]["failed"] == Json({2, 5}));
    for (const std::string& name : out.names()) CHECK((content_of(out / name) == content_of(whole / name)));
    CHECK(out.names().size() == 4);
  }
  {
    const TemporaryFolder out;
    const RunResult result = run_program(job(out) + Arguments{"--fail-fast"});
    CHECK(result.code == 4);
    CHECK(out.names() == Names{"x.0001.exr"});
  }
  // The camera goes by the frames that can be read, and the others are told.
  write_text(in / "g.0001.vdb", "no level set");
  const TemporaryFolder out;
  const RunResult result = run_program(job(out));
  CHECK(result.code == 4);
  CHECK(json_lines(result.out).back()["camera_frames"] == Json({3, 6}));
  CHECK_THAT(result.err, Catch::Contains("no camera by frame 1"));
}

TEST_CASE("fault 9: an input that changes while it is read, or is gone, fails its frame") {
  const TemporaryFolder folder;
  write_boxes(folder, 1, 2);
  const std::vector<levelray::FramePattern> inputs{levelray::FramePattern(folder / "in.####.obj")};
  levelray::FrameInputs frames(inputs, "error");
  const auto found = frames.find(1);
  CHECK_NOTHROW(frames.check_unchanged(found));
  const auto time = fs::last_write_time(folder / "in.0001.obj");
  fs::last_write_time(folder / "in.0001.obj", time + std::chrono::seconds(1));
  CHECK_THROWS_WITH(frames.check_unchanged(found), Catch::Contains("changed while it was read"));
  fs::last_write_time(folder / "in.0001.obj", time);
  CHECK_NOTHROW(frames.check_unchanged(found));
  write_text(folder / "in.0001.obj", "longer or shorter");
  fs::last_write_time(folder / "in.0001.obj", time);
  CHECK_THROWS_WITH(frames.check_unchanged(found), Catch::Contains("changed while it was read"));
  fs::remove(folder / "in.0001.obj");
  CHECK_THROWS_WITH(frames.check_unchanged(found), Catch::Contains("No such file"));
  CHECK_THAT(frames.find(1).missing, Catch::Contains("no such file"));

  // The program, with a reader that finds the file of frame 2 written again, and that of frame 3 removed.
  const TemporaryFolder tools, out;
  write_boxes(folder, 1, 4);
  CHECK(run_program(
            {"convert", folder / "in.####.obj", folder / "g.####.vdb", "-f", "1-4", "--resolution", "16"})
            .code == 0);
  const std::string real =
      fs::path(LEVELRAY_PROGRAM).parent_path().parent_path().parent_path() / "lib/levelray-vdb-reader";
  write_text(tools / "reader",
             "#!/bin/sh\ncase \"$2\" in *g.0002.vdb) touch \"$2\";; *g.0003.vdb) rm \"$2\";; esac\n"
             "exec '" +
                 real + "' \"$@\"\n");
  fs::permissions(tools / "reader", fs::perms(0755));
  RunOptions options;
  options.in_child = [&] { ::setenv("LEVELRAY_VDB_READER", (tools / "reader").c_str(), 1); };
  const RunResult result = run_program(
      {"render", folder / "g.####.vdb", "-f", "1-4", "-o", out / "x.####.png", "--size", "24x16"}, options);
  INFO(result.err);
  CHECK(result.code == 4);
  CHECK_THAT(result.err, Catch::Contains("frame 2: ") && Catch::Contains("changed while it was read") &&
                             Catch::Contains("frame 3: ") && Catch::Contains("2 of 4 frames failed: 2-3"));
  CHECK(out.names() == Names{"x.0001.png", "x.0004.png"});
  const RunResult single =
      run_program({"render", folder / "g.0002.vdb", "-o", out / "y.png", "--size", "24x16"}, options);
  CHECK(single.code == 3);
  CHECK_THAT(single.err, Catch::Contains("changed while it was read"));
}

TEST_CASE("fault 20: a movie is made of the frames, of those that were there before, too; without ffmpeg the "
          "frames "
          "are kept") {
  const TemporaryFolder in;
  write_boxes(in, 1, 4);
  const auto job = [&](const TemporaryFolder& out, const std::string& kind) {
    return Arguments{"render",
                     in / "in.####.obj",
                     "-f",
                     "1-4",
                     "-o",
                     out / ("x.####" + kind),
                     "--resolution",
                     "16",
                     "--size",
                     "33x25",
                     "--movie",
                     out / "m.mp4",
                     "--skip-existing"};
  };
  {
    const TemporaryFolder out, tools;
    RunOptions options;
    options.in_child = [&] { ::setenv("PATH", tools.path().c_str(), 1); };
    const RunResult missing = run_program(job(out, ".png"), options);
    CHECK(missing.code == 1);
    CHECK_THAT(missing.err, Catch::Contains("no program ffmpeg") && Catch::Contains("frames are kept"));
    CHECK(out.names().size() == 4);

    // One that dies at once, and one that reads a little and then fails with words.
    for (const char* script :
         {"#!/bin/sh\nkill -9 $$\n", "#!/bin/sh\nhead -c 100 >/dev/null\necho out of film >&2\nexit 3\n"}) {
      write_text(tools / "ffmpeg", script);
      fs::permissions(tools / "ffmpeg", fs::perms(0755));
      RunOptions with_script;
      with_script.in_child = [&] { ::setenv("PATH", (tools.path() + ":/usr/bin:/bin").c_str(), 1); };
      const RunResult dies = run_program(job(out, ".png"), with_script);
      INFO(dies.err);
      CHECK(dies.code == 1);
      CHECK_THAT(dies.err, Catch::Contains("m.mp4: no movie: ffmpeg ") && Catch::Contains("frames are kept"));
      CHECK((Catch::Contains("signal 9") || Catch::Contains("out of film")).match(dies.err));
      CHECK(out.names().size() == 4);
    }
  }
  if (!has_tool("ffmpeg")) {
    WARN("not tested with ffmpeg: there is none");
    return;
  }
  for (const std::string kind : {".png", ".exr"}) {
    const TemporaryFolder out;
    const RunResult result = run_program(job(out, kind));
    INFO(result.err);
    CHECK(result.code == 0);
    const std::string movie = content_of(out / "m.mp4");
    CHECK(movie.size() > 500);
    CHECK(out.names().size() == 5);
    // Resumed with some of the frames there: the same movie, of all of them.
    fs::remove(out / ("x.0002" + kind));
    write_text(out / "m.mp4", "older");
    const RunResult again = run_program(job(out, kind));
    CHECK(again.code == 0);
    CHECK_THAT(again.out, Catch::Contains("1 rendered, 3 skipped"));
    CHECK(content_of(out / "m.mp4") == movie);
  }
}
