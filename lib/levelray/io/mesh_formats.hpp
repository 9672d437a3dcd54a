// The readers of the formats, behind `parse_mesh`, and what tells the formats apart.
#pragma once

#include "levelray/io/soup_builder.hpp"

#include <string>

namespace levelray {

// Each reads builder.source() as a whole. Throws Error(bad_input), Error(limit) and Cancelled.
MeshFile read_obj(SoupBuilder& builder);
MeshFile read_ply(SoupBuilder& builder);
MeshFile read_stl(SoupBuilder& builder);
MeshFile read_off(SoupBuilder& builder);

// Whether the file is as long as the triangle count of a binary STL header says, and has triangles.
bool is_exact_binary_stl(const MeshSource& source) noexcept;

// The format that the bytes themselves name: "ply", "stl", "off", or empty when they do not say (OBJ has no
// mark, and some STL and OFF files have none). Throws Error(bad_input) for what is unmistakably something
// else: compressed files, pictures, other mesh formats, UTF-16 text.
std::string sniff_format(const MeshSource& source);

} // namespace levelray
