// The rays that measurements are made with.
#pragma once

#include "levelray/core/ray.hpp"
#include "levelray/render/camera.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace levelray {

// The centres of the pixels of a square image. They follow each other in 32x32 tiles, and in them in squares
// of 4x4 pixels, so that runs of 1024 and of 16 are coherent; the last tiles of sizes that are no multiple of
// 32 are smaller.
std::vector<std::array<double, 2>> tiled_pixels(int size);

// The rays through them, unit directions.
std::vector<WorldRay> primary_rays(const Camera& camera);

// `count` rays between two random points of the sphere around a box, grown by a tenth: uniform over its
// lines. Unit directions; they begin on the sphere and have no end. By the 64-bit Mersenne twister and
// arithmetic of our own, so that a seed gives the same rays everywhere.
std::vector<WorldRay> random_chords(const Box3d& box, std::size_t count, std::uint64_t seed);

} // namespace levelray
