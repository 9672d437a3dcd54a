#include "levelray/core/error.hpp"
#include "levelray/grid/complete_blocks.hpp"
#include "levelray/io/limited_process.hpp"
#include "levelray/vdb/level_set_check.hpp"
#include "levelray/vdb/read_local.hpp"
#include "levelray/vdb/reader_process.hpp"
#include "levelray/vdb/vdb_file.hpp"

namespace levelray {

namespace {

// Turns down what is plainly no OpenVDB file, before OpenVDB sees it.
void check_is_vdb(const std::string& path) {
  check_first_bytes(path, std::string_view(" BDV\0\0\0\0", 8), "an OpenVDB file");
}

} // namespace

VdbFile read_vdb(const std::string& path, const VdbReadOptions& options) {
  check_is_vdb(path);
  VdbFile file =
      options.trust_input ? read_vdb_here(path, options) : read_in_child(path, options, /*list_only=*/false);
  complete_blocks(file.grid, options.max_memory);
  for (std::string& remark : level_set_remarks(file.grid)) file.warnings.push_back(std::move(remark));
  return file;
}

std::vector<VdbGridInfo> list_vdb(const std::string& path, const VdbReadOptions& options) {
  check_is_vdb(path);
  return options.trust_input ? list_vdb_here(path) : read_in_child(path, options, /*list_only=*/true).grids;
}

} // namespace levelray
