// Reading in this very process: the work behind read_vdb and list_vdb.
#pragma once

#include "levelray/vdb/vdb_file.hpp"

namespace levelray {

// As read_vdb and list_vdb, on the calling process's own risk, memory and time.
VdbFile read_vdb_here(const std::string& path, const VdbReadOptions& options);
std::vector<VdbGridInfo> list_vdb_here(const std::string& path);

} // namespace levelray
