// What a surface does with light.
#pragma once

#include "levelray/core/vec.hpp"

#include <cstdint>

namespace levelray {

enum class MaterialKind : std::uint8_t {
  diffuse, // Lambert's cosine law
  phong,   // the same with a highlight
  mirror,  // reflects one direction
  glass    // reflects one direction and refracts another; closed objects
};

struct Material {
  MaterialKind kind = MaterialKind::diffuse;
  Vec3d albedo{0.72, 0.72, 0.70}; // diffuse, phong: scene-linear, [0,1]
  double specular = 0;            // strength of the lights' highlights; every kind but diffuse has them
  double exponent = 32;           // their width: larger is narrower
  double ior = 1.5;               // glass: index of refraction relative to what is around it, > 0
  Vec3d tint{1, 1, 1}; // mirror: the part that is reflected; glass: the part that one world unit of
                       // way inside lets through; [0,1]
};

} // namespace levelray
