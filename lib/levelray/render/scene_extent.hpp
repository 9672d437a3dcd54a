// Where the surfaces of a scene's objects are, for framing and for the ground.
#pragma once

#include "levelray/render/scene.hpp"

#include <span>
#include <vector>

namespace levelray {

// As surface_support and surface_bounds (render/surface_extent.hpp), of all instances in world space.
std::vector<double> scene_support(std::span<const Instance> instances, std::span<const Vec3d> directions);
Box3d scene_bounds(std::span<const Instance> instances);

} // namespace levelray
