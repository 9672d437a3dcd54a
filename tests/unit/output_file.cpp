#include "levelray/io/output_file.hpp"

#include "levelray/core/error.hpp"
#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

using namespace levelray;
using levelray::test::TemporaryFolder;
namespace fs = std::filesystem;

namespace {

std::string content_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream out;
  out << file.rdbuf();
  return out.str();
}

// The message of the Error(cannot_write) that `work` throws; "" when it throws none.
template <class Work>
std::string write_error(Work&& work) {
  try {
    work();
  } catch (const Error& error) {
    CHECK(error.kind() == ErrorKind::cannot_write);
    return error.what();
  }
  return "";
}

} // namespace

TEST_CASE("a file is written whole and nothing else is left in its folder") {
  const TemporaryFolder folder;
  const std::string path = folder / "out.bin";
  write_file_atomically(path, "first");
  CHECK(content_of(path) == "first");
  write_file_atomically(path, std::string(100000, 'x'));
  CHECK(content_of(path) == std::string(100000, 'x'));
  CHECK(folder.names() == std::vector<std::string>{"out.bin"});
}

TEST_CASE("a write that throws leaves the older file and no temporary one") {
  const TemporaryFolder folder;
  const std::string path = folder / "out.bin";
  write_file_atomically(path, "older");
  std::string temporary;
  const std::string message = write_error([&] {
    write_file_atomically(path, [&](const std::string& name) {
      temporary = name;
      std::ofstream(name) << "half";
      throw Error(ErrorKind::cannot_write, name + ": disk on fire");
    });
  });
  CHECK(message == path + ": disk on fire"); // the user's name, not the temporary one
  CHECK(fs::path(temporary).parent_path() == fs::path(path).parent_path());
  CHECK(content_of(path) == "older");
  CHECK(folder.names() == std::vector<std::string>{"out.bin"});
}

TEST_CASE("folders that do not exist and folders as targets are named with the system's reason") {
  const TemporaryFolder folder;
  const std::string missing = folder / "no/such/out.bin";
  CHECK_THAT(write_error([&] { write_file_atomically(missing, "x"); }),
             Catch::Contains(missing) && Catch::Contains("No such file or directory"));
  CHECK_THAT(write_error([&] { check_writable(missing); }), Catch::Contains("No such file or directory"));
  CHECK_THAT(write_error([&] { write_file_atomically(folder.path(), "x"); }),
             Catch::Contains("Is a directory"));
  CHECK_THAT(write_error([&] { write_file_atomically("", "x"); }), Catch::Contains("empty path"));
  check_writable(folder / "fine");
  CHECK(folder.names().empty());
}

TEST_CASE("folders and files without write permission are refused before work") {
  const TemporaryFolder folder;
  const std::string path = folder / "out.bin";
  write_file_atomically(path, "older");
  // The superuser may write anywhere, so this asks as somebody else.
  const bool superuser = ::geteuid() == 0;
  fs::permissions(folder.path(), fs::perms(0555));
  fs::permissions(path, fs::perms(0666));
  if (superuser) REQUIRE(::seteuid(65534) == 0);
  const std::string new_file = write_error([&] { check_writable(folder / "new.bin"); });
  const std::string write_new = write_error([&] { write_file_atomically(folder / "new.bin", "x"); });
  if (superuser) REQUIRE(::seteuid(0) == 0);
  fs::permissions(folder.path(), fs::perms(0777));
  fs::permissions(path, fs::perms(0444));
  if (superuser) REQUIRE(::seteuid(65534) == 0);
  const std::string old_file = write_error([&] { check_writable(path); });
  if (superuser) REQUIRE(::seteuid(0) == 0);
  CHECK_THAT(new_file, Catch::Contains("Permission denied"));
  CHECK_THAT(write_new, Catch::Contains("Permission denied"));
  CHECK_THAT(old_file, Catch::Contains("Permission denied"));
  CHECK(content_of(path) == "older");
}

TEST_CASE("a full disk is reported, and leaves nothing") {
  const TemporaryFolder folder;
  const std::string path = folder / "out.bin";
  // A limit on file sizes stands for the disk; its signal is ignored, as the program does.
  rlimit old_limit = {};
  REQUIRE(::getrlimit(RLIMIT_FSIZE, &old_limit) == 0);
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit limit{1000, old_limit.rlim_max};
  REQUIRE(::setrlimit(RLIMIT_FSIZE, &limit) == 0);
  const std::string message = write_error([&] { write_file_atomically(path, std::string(5000, 'x')); });
  REQUIRE(::setrlimit(RLIMIT_FSIZE, &old_limit) == 0);
  std::signal(SIGXFSZ, old_handler);
  CHECK_THAT(message, Catch::Contains(path) && Catch::Contains("File too large"));
  CHECK(folder.names().empty());
}

TEST_CASE("links are followed, permissions kept, devices written in place") {
  const TemporaryFolder folder;
  write_file_atomically(folder / "real", "older");
  fs::permissions(folder / "real", fs::perms(0640));
  fs::create_symlink("real", folder / "link");
  write_file_atomically(folder / "link", "newer");
  CHECK(fs::is_symlink(folder / "link"));
  CHECK(content_of(folder / "real") == "newer");
  CHECK(fs::status(folder / "real").permissions() == fs::perms(0640));
  write_file_atomically("/dev/null", "gone");
  CHECK(fs::is_character_file("/dev/null"));
  CHECK_THAT(write_error([] { write_file_atomically("/dev/full", "x"); }), Catch::Contains("No space left"));
}

TEST_CASE("temporary files of running writes can be removed from a signal handler") {
  const TemporaryFolder folder;
  const std::string path = folder / "out.bin";
  write_error([&] {
    write_file_atomically(path, [&](const std::string&) {
      CHECK(folder.names().size() == 1);
      remove_temporary_files();
      CHECK(folder.names().empty());
    });
  });
  CHECK(folder.names().empty());
}

TEST_CASE("what a killed process left of the same file is removed, and nothing else") {
  const TemporaryFolder folder;
  const auto leave = [&](const std::string& target) {
    const pid_t child = ::fork();
    if (child == 0) {
      write_file_atomically(target, [](const std::string& name) {
        std::ofstream(name) << "half";
        ::kill(::getpid(), SIGKILL);
      });
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    CHECK(WIFSIGNALED(status));
    return child;
  };
  const pid_t dead = leave(folder / "out.bin");
  leave(folder / "other.bin");
  REQUIRE(folder.names().size() == 2);
  const std::string left = folder.names()[1]; // ".other..." sorts before ".out..."
  CHECK_THAT(left, Catch::StartsWith(".out.bin.") && Catch::Contains("." + std::to_string(dead) + "."));

  // Names that are alike: of a living process, of another machine, of a longer target, of somebody else.
  char host[256] = {};
  ::gethostname(host, sizeof host - 1);
  const std::string mine = std::string(host).substr(0, 40), pid = std::to_string(dead);
  const std::vector<std::string> innocent{".out.bin." + mine + "." + std::to_string(::getpid()) +
                                              ".01234567.tmp",
                                          ".out.bin.elsewhere." + pid + ".01234567.tmp",
                                          ".out.bin.old." + mine + "." + pid + ".01234567.tmp",
                                          ".out.bin." + mine + "." + pid + ".notes.tmp",
                                          ".out.bin." + mine + "." + pid + ".01234567.tmp.txt",
                                          ".out.bin.tmp"};
  for (const std::string& name : innocent) std::ofstream(folder / name) << "keep";
  write_file_atomically(folder / "out.bin", "whole");

  const std::vector<std::string> names = folder.names();
  const auto there = [&](const std::string& name) {
    return std::count(names.begin(), names.end(), name) == 1;
  };
  CHECK_FALSE(there(left));
  CHECK(there("out.bin"));
  for (const std::string& name : innocent) CHECK(there(name));
  CHECK(names.size() == innocent.size() + 2); // and .other.bin's, whose turn has not come
}
