// Triangles that close the boundary of a mesh.
#pragma once

#include "levelray/mesh/triangle_mesh.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace levelray {

// Triangles whose oriented boundary is the chain `edges` (each vertex must be entered as often as it is
// left). They use the chain's own vertices only. For counting crossings any such triangles serve; these stay
// close to their loops: a crack gets slivers, not a fan.
std::vector<Triangle> close_boundary(const std::vector<std::array<std::uint32_t, 2>>& edges);

} // namespace levelray
