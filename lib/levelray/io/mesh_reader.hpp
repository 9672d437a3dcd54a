// Reading OBJ, PLY, STL and OFF files that nobody promised to be right.
#pragma once

#include "levelray/mesh/triangle_mesh.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace levelray {

struct MeshReadOptions {
  std::string format; // "obj", "ply", "stl", "off", or empty: by content, the file name's extension as a hint
  bool drop_bad = false; // drop faces with non-finite vertices instead of refusing the file
  bool salvage = false;  // take what is there of truncated files, with a warning, instead of refusing them
  std::uint64_t max_memory = std::uint64_t{1} << 34; // bytes that the mesh may take
};

// The formats by name, for messages and help.
const std::vector<std::string>& mesh_format_names();

// Reads `path` ("-": standard input, format required). Throws Error(bad_input) with "path:line: reason; hint"
// or "path@offset: …", Error(usage) for names of unknown formats, Error(limit) when the mesh would not fit.
// Content decides over the extension where it is unmistakable.
MeshFile read_mesh(const std::string& path, const MeshReadOptions& options = {});

// The same from bytes in memory; `name` stands for the path in messages.
MeshFile parse_mesh(const char* data, std::size_t size, const std::string& name,
                    const MeshReadOptions& options = {});

} // namespace levelray
