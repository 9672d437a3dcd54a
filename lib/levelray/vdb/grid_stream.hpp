// What the limited reader process sends to its parent, which believes none of it unchecked.
#pragma once

#include "levelray/io/reader_stream.hpp"
#include "levelray/vdb/vdb_file.hpp"

#include <string>

namespace levelray {

// `with_grid`: also the grid, whose nodes and blocks must be in the order of the table, as from_openvdb makes
// them.
void send_file(const ByteSink& write, const VdbFile& file, bool with_grid);

// The other end. Every count is checked before memory is taken for it: the grid and the texts stay within
// `max_bytes`. The grid is sound when this returns: indices within +-2^31/16 nodes, every table entry a node
// or a tile, values finite and not -0, inactive ones +-background. `cells` is empty. Throws the Error that
// was sent, or Error(bad_input) naming `path` when the bytes make no sense.
VdbFile receive_file(const ByteSource& read, const std::string& path, std::uint64_t max_bytes,
                     bool with_grid);

} // namespace levelray
