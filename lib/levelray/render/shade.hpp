// Local shading of a surface point: Lambert's cosine law and Phong's highlight.
#pragma once

#include "levelray/render/material.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace levelray {

// Ambient light, as the intensity of DirectionalLight.
inline constexpr double ambient_intensity = 0.06;

// The shading models by name: "lambert", "phong".
const std::vector<std::string>& shading_names();
// The material of the level set for a model of that name; Error(usage) with the legal names for others.
Material shading_material(std::string_view name);

// Radiance towards the eye under one light of intensity 1: diffuse of diffuse and phong materials, the
// highlight of all but diffuse ones. All directions have unit length and point away from the surface: the
// normal, to_light, to_eye. Zero where the normal faces away from the light.
//
// Phong 1975 ("Illumination for computer generated pictures", CACM 18(6), p. 315): diffuse cos(n,l) plus a
// power of the cosine between the mirrored light and the eye; ours keeps the highlight white and leaves out
// the factor that depends on the angle of incidence.
Vec3d shade_light(const Material& material, const Vec3d& normal, const Vec3d& to_light, const Vec3d& to_eye);

} // namespace levelray
