// Whole files, and standard input, in memory.
#pragma once

#include "levelray/core/uninitialized_vector.hpp"

#include <cstdint>
#include <string>

namespace levelray {

// Reads the regular file `path`, or standard input when it is "-", into memory. Reading beats mapping here: a
// file that shrinks while it is mapped ends the program with SIGBUS, one that shrinks while it is read is
// merely short. Throws Error(bad_input) "path: reason; hint" for what is missing, unreadable, empty, a
// folder, a FIFO or a device, and Error(limit) for more than `max_bytes`.
uninitialized_vector<char> read_input(const std::string& path, std::uint64_t max_bytes);

} // namespace levelray
