#include "levelray/vdb/reader_process.hpp"

#include "levelray/io/limited_process.hpp"
#include "levelray/vdb/grid_stream.hpp"

#include <fmt/format.h>

namespace levelray {

VdbFile read_in_child(const std::string& path, const VdbReadOptions& options, bool list_only) {
  VdbFile file;
  read_in_process(
      {"levelray-vdb-reader", "LEVELRAY_VDB_READER", ".vdb files"},
      {list_only ? "list" : "read", path, options.grid, std::to_string(options.max_memory),
       fmt::format("{:.3f}", options.timeout_seconds), options.iso ? fmt::format("{:a}", *options.iso) : ""},
      path, options.timeout_seconds,
      [&](const ByteSource& source) { file = receive_file(source, path, options.max_memory, !list_only); });
  return file;
}

} // namespace levelray
