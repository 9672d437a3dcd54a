// Faults 11, 12, 13, 17, 19, 21 and 22: memory, hostile files, clocks, threads, names, left-overs.
#include "support/catch.hpp"
#include "support/sequence_job.hpp"

#include <filesystem>

using namespace levelray::test;
namespace fs = std::filesystem;

TEST_CASE("fault 11: memory that runs out anywhere, also in a worker thread, ends cleanly and soon") {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  WARN("skipped: sanitizers have allocators of their own");
#else
  if (!has_tool("fiu-run")) {
    WARN("skipped: there is no fiu-run (package fiu-utils)");
    return;
  }
  const TemporaryFolder in;
  write_boxes(in, 1, 3);
  std::map<int, int> codes;
  for (int round = 0; round < 40; ++round) {
    const TemporaryFolder out;
    RunOptions options;
    const std::string probability = round % 2 ? "0.001" : "0.00005";
    options.under = {
        "timeout", "-s", "KILL", "60", "fiu-run",
        "-x",      "-f", "",     "-c", "enable_random name=libc/mm/*,probability=" + probability};
    const RunResult result = run_program({"render", in / "in.####.obj", "-f", "1-3", "-o", out / "x.####.exr",
                                          "--resolution", "60", "--size", "60x40"},
                                         options);
    ++codes[result.code];
    INFO("round " << round << ": " << result.code << " " << result.err);
    // 127: the loader or the shell of fiu-run got no memory. The words of the standard library's own handler
    // can only come from before main, where libraries start: from there on the program has one with other
    // words.
    const bool before_main =
        result.code == 127 || (result.code == 134 && result.err.starts_with("terminate called"));
    const bool clean = result.code == 0 || result.code == 1 || result.code == 4 || result.code == 5 ||
                       result.code == 74 || before_main;
    CHECK(clean);
    for (const std::string& name : out.names()) CHECK_FALSE(name.starts_with('.'));
  }
  CHECK(codes.size() > 1);
#endif
}

TEST_CASE("faults 12 and 13: a reader that crashes or hangs fails its frame only") {
  const TemporaryFolder in, tools;
  write_boxes(in, 1, 3);
  CHECK(run_program({"convert", in / "in.####.obj", in / "g.####.vdb", "-f", "1-3", "--resolution", "16"})
            .code == 0);
  // Stands in for the real reader, and does to frame 2 what hostile files did to OpenVDB's. What the real one
  // does with such files is in tests/unit/vdb_reader_process.cpp and tests/fuzz/vdb_mutations.cpp.
  const std::string real =
      fs::path(LEVELRAY_PROGRAM).parent_path().parent_path().parent_path() / "lib/levelray-vdb-reader";
  REQUIRE(fs::exists(real));
  for (const std::string misdeed : {"kill -11 $$", "exec sleep 100"}) {
    write_text(tools / "reader",
               "#!/bin/sh\ncase \"$2\" in *g.0002.vdb) " + misdeed + ";; esac\nexec '" + real + "' \"$@\"\n");
    fs::permissions(tools / "reader", fs::perms(0755));
    const TemporaryFolder out;
    RunOptions options;
    options.in_child = [&] { ::setenv("LEVELRAY_VDB_READER", (tools / "reader").c_str(), 1); };
    const RunResult result = run_program({"render", in / "g.####.vdb", "-f", "1-3", "-o", out / "x.####.png",
                                          "--size", "24x16", "--read-timeout", "2"},
                                         options);
    INFO(misdeed << ": " << result.err);
    CHECK(result.code == 4);
    CHECK_THAT(result.err,
               Catch::Contains("frame 2: " + in.path() + "/g.0002.vdb: ") &&
                   Catch::Contains(misdeed[0] == 'k' ? "reader crashed (signal 11)" : "longer than 2 s"));
    CHECK(out.names() == Names{"x.0001.png", "x.0003.png"});
  }
}

TEST_CASE("fault 17: clock, time zone and locale change no byte and no decimal point") {
  const TemporaryFolder in, plain;
  write_boxes(in, 1, 2);
  const auto job = [&](const TemporaryFolder& to) {
    return Arguments{"render",          in / "in.####.obj", "-f", "1-2",    "-o",    to / "x.####.exr", "-o",
                     to / "x.####.png", "--resolution",     "16", "--size", "24x16", "--json",          "-"};
  };
  CHECK(run_program(job(plain)).code == 0);
  {
    const TemporaryFolder out, locales;
    // A locale with a decimal comma, made for this test where the system has the sources of locales.
    const bool made =
        std::system(
            ("localedef -i de_DE -f UTF-8 '" + (locales / "de_DE.UTF-8") + "' >/dev/null 2>&1").c_str()) == 0;
    if (!made) WARN("not tested with a decimal comma: localedef has no de_DE (package locales)");
    RunOptions options;
    options.in_child = [&] {
      ::setenv("LOCPATH", locales.path().c_str(), 1);
      ::setenv("LC_ALL", "de_DE.UTF-8", 1);
      ::setenv("TZ", "Pacific/Kiritimati", 1);
    };
    const RunResult result = run_program(job(out), options);
    CHECK(result.code == 0);
    CHECK((contents(out) == contents(plain)));
    CHECK(json_lines(result.out).size() == 3);
  }
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  if (!has_tool("faketime")) {
    WARN("not tested with another clock: there is no faketime");
    return;
  }
  for (const char* when : {"1999-12-31 23:59:59", "2040-01-01 00:00:00"}) {
    const TemporaryFolder out;
    RunOptions options;
    options.under = {"faketime", when};
    const RunResult result = run_program(job(out), options);
    INFO(when << ": " << result.err);
    CHECK(result.code == 0);
    CHECK((contents(out) == contents(plain)));
  }
#endif
}

TEST_CASE("fault 19: 1, 2 and 7 threads give the same bytes, a hundred times") {
  const TemporaryFolder in;
  write_text(in / "ball.obj", ball_obj(12));
  std::set<std::string> grids, pictures;
  for (int round = 0; round < 100; ++round) {
    const TemporaryFolder out;
    const std::string threads = round % 3 == 0 ? "1" : round % 3 == 1 ? "2" : "7";
    CHECK(run_program({"convert", in / "ball.obj", out / "a.vdb", "--resolution", "40", "-q", "-j", threads})
              .code == 0);
    CHECK(run_program({"render", out / "a.vdb", "-o", out / "a.exr", "--aov", "all", "--shadows", "--ground",
                       "--size", "50x40", "-q", "-j", threads})
              .code == 0);
    grids.insert(content_of(out / "a.vdb"));
    pictures.insert(content_of(out / "a.exr"));
  }
  CHECK(grids.size() == 1);
  CHECK(pictures.size() == 1);
}

TEST_CASE("fault 21: names with spaces, UTF-8, newlines, a dash in front or 255 bytes work, or are refused") {
  const TemporaryFolder folder;
  const std::string longest(251, 'n');
  for (const std::string name :
       {"with spaces", "gr\xC3\xBC\xC3\x9F", "two\nlines", "-dash", "'quotes\"$(x)", longest.c_str()}) {
    INFO(name);
    const std::string mesh = folder / (name.substr(0, 251) + ".obj");
    write_text(mesh, box_obj(1, 1, 1));
    const RunResult result = run_program({"render", mesh, "-o", folder / (name + ".png"), "--resolution", "9",
                                          "--size", "9x9", "--json", "-"});
    INFO(result.err);
    CHECK(result.code == 0);
    CHECK(fs::exists(folder / (name + ".png")));
    fs::remove(mesh);
    fs::remove(folder / (name + ".png"));
  }
  CHECK(folder.names().empty());
  // From within the folder, where the dash really comes first; "--" ends the options.
  write_text(folder / "-dash.0001.obj", box_obj(1, 1, 1));
  RunOptions options;
  options.in_child = [&] {
    if (::chdir(folder.path().c_str()) != 0) ::_exit(125);
  };
  CHECK(run_program({"convert", "-f", "1", "--resolution", "9", "--", "-dash.####.obj", "-out.####.vdb"},
                    options)
            .code == 0);
  CHECK(fs::exists(folder / "-out.0001.vdb"));
  const RunResult too_long =
      run_program({"render", folder / "-dash.0001.obj", "-o", folder / (std::string(300, 'n') + ".png")});
  CHECK((too_long.code == 2 || too_long.code == 74));
  CHECK_THAT(too_long.err, Catch::Contains("File name too long"));
}

TEST_CASE("fault 22: left-overs do not hinder, and what may not be replaced is told before work") {
  const TemporaryFolder folder;
  write_boxes(folder, 1, 2);
  write_text(folder / ".x.0001.png.tmp", "somebody's");
  const Arguments job{"render",       folder / "in.####.obj",
                      "-f",           "1-2",
                      "-o",           folder / "x.####.png",
                      "--resolution", "9",
                      "--size",       "9x9"};
  CHECK(run_program(job).code == 0);
  CHECK(content_of(folder / ".x.0001.png.tmp") == "somebody's");

  fs::permissions(folder / "x.0001.png", fs::perms(0444));
  const std::string before = content_of(folder / "x.0001.png");
  RunOptions options;
  options.in_child = obey_permissions;
  const RunResult result = run_program(job + Arguments{"--shadows"}, options);
  CHECK(result.code == 74);
  CHECK_THAT(result.err, Catch::Contains("x.0001.png") && Catch::Contains("Permission denied"));
  CHECK(content_of(folder / "x.0001.png") == before);
}
