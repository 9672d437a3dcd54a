// Counters as pictures.
#pragma once

#include "levelray/core/vec.hpp"
#include "levelray/render/image.hpp"

namespace levelray {

// The colour of a fraction in [0,1], scene-linear, from black to white.
//
// Source: Green 2011, "A colour scheme for the display of astronomical intensity images", Bulletin of the
// Astronomical Society of India 39, 289 (cubehelix: start 0.5, -1.5 rotations, hue 1, gamma 1): a helix
// around the grey diagonal, along which perceived brightness grows evenly. Its values are display values
// (sRGB); ours are decoded to linear ones, which is what images hold. Values beyond [0,1] are clamped.
Vec3f false_colour(double fraction);

// Replaces R, G, B by the false colours of that channel, from 0 to its largest value, and A by 1. Returns
// that value: what white means. There must be such a channel; values are finite and >= 0.
float show_channel(Image& image, std::string_view name);

} // namespace levelray
