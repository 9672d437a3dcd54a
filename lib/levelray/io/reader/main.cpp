// levelray-exr-reader: reads one OpenEXR file under limits and writes the picture to standard output for its
// parent.
//
//   levelray-exr-reader FILE MAX_MEMORY TIMEOUT_SECONDS
//
// Not for people: see levelray/io/limited_process.hpp.

#include "levelray/io/exr_reader.hpp"
#include "levelray/io/limited_child.hpp"

#include <cstdio>
#include <cstdlib>

using namespace levelray;

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fputs("levelray-exr-reader serves levelray; it is not meant to be called by hand\n", stderr);
    return 2;
  }
  const std::string path = argv[1];
  const std::uint64_t max_memory = std::strtoull(argv[2], nullptr, 10);
  serve_limited(path, max_memory, std::strtod(argv[3], nullptr), [&](const ByteSink& sink) {
    // Once the headers tell what the picture takes, a damaged rest may take no more.
    send_exr(sink, read_exr_here(path, max_memory, limit_memory_further));
  });
}
