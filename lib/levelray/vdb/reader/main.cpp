// levelray-vdb-reader: reads one OpenVDB file under limits and writes the grid to standard output for its
// parent.
//
//   levelray-vdb-reader read|list FILE GRID MAX_MEMORY TIMEOUT_SECONDS ISO
//
// ISO is a hexadecimal float, or empty.
//
// Not for people: see levelray/vdb/README.md.

#include "levelray/io/limited_child.hpp"
#include "levelray/vdb/grid_stream.hpp"
#include "levelray/vdb/read_local.hpp"

#include <cstdio>
#include <cstdlib>
#include <cstring>

using namespace levelray;

int main(int argc, char** argv) {
  if (argc != 7) {
    std::fputs("levelray-vdb-reader serves levelray; it is not meant to be called by hand\n", stderr);
    return 2;
  }
  const bool list_only = std::strcmp(argv[1], "list") == 0;
  const std::string path = argv[2];
  VdbReadOptions options;
  options.grid = argv[3];
  options.max_memory = std::strtoull(argv[4], nullptr, 10);
  if (*argv[6]) options.iso = std::strtof(argv[6], nullptr);
  serve_limited(path, options.max_memory, std::strtod(argv[5], nullptr), [&](const ByteSink& sink) {
    VdbFile file;
    if (list_only)
      file.grids = list_vdb_here(path);
    else
      file = read_vdb_here(path, options);
    send_file(sink, file, !list_only);
  });
}
