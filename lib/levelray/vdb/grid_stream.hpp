// What the limited reader process sends to its parent, which believes none of it unchecked.
#pragma once

#include "levelray/core/error.hpp"
#include "levelray/vdb/vdb_file.hpp"

#include <cstddef>
#include <functional>
#include <optional>
#include <string>

namespace levelray {

// Calls write(bytes, count) for consecutive pieces.
using ByteSink = std::function<void(const void* bytes, std::size_t count)>;
// Fills `count` bytes, or throws.
using ByteSource = std::function<void(void* bytes, std::size_t count)>;

void send_error(const ByteSink& write, ErrorKind kind, const std::string& text);

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
