// The header of a PLY file: what is in it, in which order, as which types.
#pragma once

#include "levelray/io/mesh_source.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace levelray {

enum class PlyType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };
std::size_t ply_type_size(PlyType type) noexcept;
inline bool is_integer(PlyType type) noexcept {
  return type != PlyType::float32 && type != PlyType::float64;
}

enum class PlyEncoding { ascii, little_endian, big_endian };

struct PlyProperty {
  std::string name;
  bool is_list = false;
  PlyType count_type = PlyType::uint8; // of lists
  PlyType type = PlyType::float32;
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  const char* at = nullptr; // its header line
  std::vector<PlyProperty> properties;

  std::string plural() const; // "vertices", "faces", "edge elements"
  // Bytes that an instance takes at least in a binary file, or two for each value in a text: a digit, a
  // space.
  std::uint64_t least_bytes(PlyEncoding encoding) const noexcept;
};

struct PlyHeader {
  PlyEncoding encoding = PlyEncoding::ascii;
  std::vector<PlyElement> elements;
  const char* body = nullptr;
};

// G. Turk, "The PLY Polygon File Format" (1994), and the type names of its later writers (int8, float32, …).
// Reads at most 64 KiB. Throws Error(bad_input) with the line of what is not legal.
PlyHeader read_ply_header(const MeshSource& source);

} // namespace levelray
