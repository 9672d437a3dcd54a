#include "levelray/mesh/weld.hpp"

#include "levelray/core/parallel.hpp"

#include <bit>
#include <limits>

namespace levelray {

namespace {

constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

// -0 + 0 is +0; every other number stays.
Vec3d without_negative_zero(const Vec3d& v) {
  return Vec3d(v.x + 0.0, v.y + 0.0, v.z + 0.0);
}

// Mixes the bits of a position: multiplication by odd constants (the golden ratio's and two primes of
// xxHash64) carries low bits up, the shifts bring high bits down, where the table's mask looks.
std::uint64_t hash(const Vec3d& v) {
  std::uint64_t h = std::bit_cast<std::uint64_t>(v.x) * 0x9E3779B97F4A7C15ull;
  h = (h ^ (h >> 32) ^ std::bit_cast<std::uint64_t>(v.y)) * 0xC2B2AE3D27D4EB4Full;
  h = (h ^ (h >> 32) ^ std::bit_cast<std::uint64_t>(v.z)) * 0x165667B19E3779F9ull;
  return h ^ (h >> 29);
}

// For each vertex the first one at its position.
std::vector<std::uint32_t> first_at_position(const std::vector<Vec3d>& vertices) {
  const std::size_t slots = std::bit_ceil(2 * vertices.size() + 1);
  std::vector<std::uint32_t> table(slots, none); // open addressing, at most half full
  std::vector<std::uint32_t> first(vertices.size());
  for (std::uint32_t i = 0; i < vertices.size(); ++i) {
    if (i % 65536 == 0) check_cancel();
    const Vec3d v = without_negative_zero(vertices[i]);
    std::size_t slot = hash(v) & (slots - 1);
    while (table[slot] != none && vertices[table[slot]] != v) slot = (slot + 1) & (slots - 1);
    if (table[slot] == none) table[slot] = i;
    first[i] = table[slot];
  }
  return first;
}

} // namespace

WeldedMesh weld(const TriangleMesh& mesh) {
  WeldedMesh out;
  const std::vector<std::uint32_t> first = first_at_position(mesh.vertices);
  std::vector<bool> referenced(mesh.vertices.size(), false);
  for (const Triangle& t : mesh.triangles)
    for (const std::uint32_t v : t) referenced[v] = true;
  for (std::uint32_t i = 0; i < first.size(); ++i) {
    out.merged_vertices += first[i] != i;
    out.unreferenced_vertices += !referenced[i];
  }

  // Keep triangles with three positions, and mark the positions that they use.
  std::vector<std::uint32_t> renamed(mesh.vertices.size(), none);
  out.mesh.triangles.reserve(mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) {
    const Triangle w{first[t[0]], first[t[1]], first[t[2]]};
    if (w[0] == w[1] || w[1] == w[2] || w[2] == w[0]) {
      ++out.collapsed_triangles;
      continue;
    }
    out.mesh.triangles.push_back(w);
    for (const std::uint32_t v : w) renamed[v] = 0;
  }

  // Number them.
  for (std::uint32_t i = 0; i < renamed.size(); ++i) {
    if (renamed[i] == none) continue;
    renamed[i] = static_cast<std::uint32_t>(out.mesh.vertices.size());
    out.mesh.vertices.push_back(without_negative_zero(mesh.vertices[i]));
  }
  for (Triangle& t : out.mesh.triangles) t = {renamed[t[0]], renamed[t[1]], renamed[t[2]]};
  return out;
}

} // namespace levelray
