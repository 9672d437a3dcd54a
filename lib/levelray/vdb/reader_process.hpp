// Reading OpenVDB files in a process of its own, because OpenVDB's reader may crash, hang or eat memory on
// bad files.
#pragma once

#include "levelray/vdb/vdb_file.hpp"

namespace levelray {

// Starts the program `levelray-vdb-reader`, which limits itself (address space, CPU time, no files, no core
// dumps), reads the file and sends the grid through a pipe. It is searched at $LEVELRAY_VDB_READER, beside
// the running program, in ../libexec/levelray, ../lib/levelray, ../lib and ../../lib from there, and where it
// is installed.
//
// As read_vdb_here, or with `list_only` as list_vdb_here; besides what these throw: Error(bad_input) when the
// reader crashed, Error(limit) when it took longer than options.timeout_seconds or more memory than
// options.max_memory, Error(failed) when it cannot be found or started, Cancelled.
VdbFile read_in_child(const std::string& path, const VdbReadOptions& options, bool list_only);

} // namespace levelray
