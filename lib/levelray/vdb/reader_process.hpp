// Reading OpenVDB files in a process of its own, because OpenVDB's reader may crash, hang or eat memory on
// bad files.
#pragma once

#include "levelray/vdb/vdb_file.hpp"

namespace levelray {

// Lets the program `levelray-vdb-reader` read the file under limits and send the grid through a pipe; see
// io/limited_process.hpp for where it is searched ($LEVELRAY_VDB_READER first) and what may go wrong.
//
// As read_vdb_here, or with `list_only` as list_vdb_here; besides what these throw: Error(bad_input) when the
// reader crashed, Error(limit) when it took longer than options.timeout_seconds or more memory than
// options.max_memory, Error(failed) when it cannot be found or started, Cancelled.
VdbFile read_in_child(const std::string& path, const VdbReadOptions& options, bool list_only);

} // namespace levelray
