#include "levelray/io/limited_child.hpp"

#include "levelray/core/parallel.hpp"

#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <new>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

namespace levelray {

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
  limit_memory_further(max_memory);
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

// What is said when memory runs out, made while there is some. Out of memory, destructors of the libraries
// beneath may throw and end the program, so the answer is sent where the allocation fails.
std::string g_out_of_memory;
bool g_sending = false;

void out_of_memory() {
  if (g_sending) ::_exit(1);
  write_all(g_out_of_memory.data(), g_out_of_memory.size());
  ::_exit(0);
}

} // namespace

void limit_memory_further(std::uint64_t bytes) {
#if !defined(__SANITIZE_ADDRESS__) &&                                                                        \
    !defined(__SANITIZE_THREAD__) // their shadows need terabytes of addresses
  rlimit now{};
  const std::uint64_t wanted = address_space() + bytes;
  if (::getrlimit(RLIMIT_AS, &now) == 0 && now.rlim_cur != RLIM_INFINITY && now.rlim_cur <= wanted) return;
  limit(RLIMIT_AS, wanted);
#else
  (void)bytes;
#endif
}

void serve_limited(const std::string& path, std::uint64_t max_memory, double seconds,
                   const std::function<void(const ByteSink&)>& work) {
  send_error([](const void* bytes,
                std::size_t count) { g_out_of_memory.append(static_cast<const char*>(bytes), count); },
             ErrorKind::limit,
             path + ": reading needs more memory than the " + std::to_string(max_memory >> 20) +
                 " MiB allowed");
  std::set_new_handler(out_of_memory);
  const ThreadLimit one_thread(1); // threads' stacks and heaps would count against the address space
  limit_myself(max_memory, seconds);

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
    work(sink);
  } catch (const Error& error) {
    send_error(sink, error.kind(), error.what());
  } catch (const std::bad_alloc&) { // of allocators that do not ask out_of_memory
    out_of_memory();
  } catch (const std::exception& error) {
    send_error(sink, ErrorKind::bad_input, path + ": " + printable(error.what(), 160));
  }
  flush();
  ::_exit(0);
}

} // namespace levelray
