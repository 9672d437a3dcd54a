// A camera that goes round what it looks at.
#pragma once

#include "levelray/grid/block_grid.hpp"
#include "levelray/render/camera.hpp"

#include <span>
#include <vector>

namespace levelray {

// `camera` turned by `turns` about the axis through its target along its up: anticlockwise seen from above,
// so that the object seems to turn clockwise.
CameraSettings turned_camera(const CameraSettings& camera, double turns);

// For each direction d, the largest dot(p, d) of the points p that the grid's surface sweeps when it is
// turned about the axis through `centre` along `up`; world units. Taken at 64 angles, between which the sweep
// bulges by at most 1 - cos(pi/64) = 0.12% of its radius: far less than the margin that framing_camera keeps.
std::vector<double> turned_surface_support(const BlockGrid& grid, const Vec3d& up, const Vec3d& centre,
                                           std::span<const Vec3d> directions);

} // namespace levelray
