// levelray-vdb-reader: reads one OpenVDB file under limits and writes the grid to standard output for its
// parent.
//
//   levelray-vdb-reader read|list FILE GRID MAX_MEMORY TIMEOUT_SECONDS
//
// Not for people: see levelray/vdb/README.md.

#include "levelray/core/error.hpp"
#include "levelray/core/parallel.hpp"
#include "levelray/vdb/grid_stream.hpp"
#include "levelray/vdb/read_local.hpp"

#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <new>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

using namespace levelray;

namespace {

void limit(__rlimit_resource what, rlim_t value) {
  const rlimit both{value, value};
  ::setrlimit(what, &both);
}

// The bytes of address space in use now: libraries and stacks, which are no fault of the file.
[[maybe_unused]] std::uint64_t address_space() {
  unsigned long pages = 0;
  if (std::FILE* file = std::fopen("/proc/self/statm", "r")) {
    if (std::fscanf(file, "%lu", &pages) != 1) pages = 0;
    std::fclose(file);
  }
  return pages ? pages * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE)) : std::uint64_t{256} << 20;
}

void limit_myself(std::uint64_t max_memory, double seconds) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
  ::close_range(3, ~0u, 0); // whatever the parent had open
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_FSIZE, 0);
  limit(RLIMIT_NOFILE, 16);
  limit(RLIMIT_CPU, static_cast<rlim_t>(std::ceil(seconds)) + 1);
#if !defined(__SANITIZE_ADDRESS__) &&                                                                        \
    !defined(__SANITIZE_THREAD__) // their shadows need terabytes of addresses
  limit(RLIMIT_AS, address_space() + max_memory);
#else
  (void)max_memory;
#endif
}

void write_all(const void* bytes, std::size_t count) {
  const char* at = static_cast<const char*>(bytes);
  while (count) {
    const ssize_t done = ::write(STDOUT_FILENO, at, count);
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) ::_exit(1); // the parent is gone
    at += done;
    count -= static_cast<std::size_t>(done);
  }
}

// What is said when memory runs out, made while there is some. Out of memory, OpenVDB's destructors throw and
// end the program, so the answer is sent where the allocation fails.
std::string g_out_of_memory;
bool g_sending = false;

void out_of_memory() {
  if (g_sending) ::_exit(1);
  write_all(g_out_of_memory.data(), g_out_of_memory.size());
  ::_exit(0);
}

} // namespace

int main(int argc, char** argv) {
  if (argc != 6) {
    std::fputs("levelray-vdb-reader serves levelray; it is not meant to be called by hand\n", stderr);
    return 2;
  }
  const bool list_only = std::strcmp(argv[1], "list") == 0;
  const std::string path = argv[2];
  VdbReadOptions options;
  options.grid = argv[3];
  options.max_memory = std::strtoull(argv[4], nullptr, 10);
  send_error([](const void* bytes,
                std::size_t count) { g_out_of_memory.append(static_cast<const char*>(bytes), count); },
             ErrorKind::limit,
             path + ": reading needs more memory than the " + std::to_string(options.max_memory >> 20) +
                 " MiB allowed");
  std::set_new_handler(out_of_memory);
  const ThreadLimit one_thread(1); // threads' stacks and heaps would count against the address space
  limit_myself(options.max_memory, std::strtod(argv[5], nullptr));

  std::string buffer; // small pieces go out together
  const auto flush = [&] {
    g_sending = true;
    write_all(buffer.data(), buffer.size());
    buffer.clear();
  };
  const ByteSink sink = [&](const void* bytes, std::size_t count) {
    if (buffer.size() + count > 65536) flush();
    if (count > 65536)
      write_all(bytes, count);
    else
      buffer.append(static_cast<const char*>(bytes), count);
  };
  try {
    VdbFile file;
    if (list_only)
      file.grids = list_vdb_here(path);
    else
      file = read_vdb_here(path, options);
    send_file(sink, file, !list_only);
  } catch (const Error& error) {
    send_error(sink, error.kind(), error.what());
  } catch (const std::bad_alloc&) { // of allocators that do not ask out_of_memory
    out_of_memory();
  } catch (const std::exception& error) {
    send_error(sink, ErrorKind::bad_input, path + ": " + printable(error.what(), 160));
  }
  flush();
  ::_exit(0); // without destructors: a damaged tree may crash in them
}
