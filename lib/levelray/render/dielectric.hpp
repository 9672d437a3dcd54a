// Mirror directions, Snell's law and Fresnel's equations.
#pragma once

#include "levelray/core/vec.hpp"

namespace levelray {

// The mirror image of a direction; n has unit length and either sense.
inline Vec3d reflected(const Vec3d& d, const Vec3d& n) {
  return d - n * (2 * d.dot(n));
}

struct Refraction {
  double reflectance = 1;   // the part that is reflected, [0,1]; 1: total reflection, and no `direction`
  Vec3d direction{0, 0, 0}; // of the rest, unit
};

// What becomes of a ray of unit direction d at a smooth boundary with the unit normal n on the ray's side
// (dot(d, n) <= 0), from a medium of index n1 into one of n2; eta = n1 / n2.
//
// Born and Wolf, Principles of Optics (7th ed. 1999), section 1.5: Snell's law (1.5.1, eq. 8) in vector form,
//   t = eta d + (eta cos_i - cos_t) n,
// and Fresnel's formulae (1.5.2, eq. 21a) for both polarisations, whose squares are averaged: light is
// unpolarised here and stays so at every boundary, which nature's does not.
Refraction refract(const Vec3d& d, const Vec3d& n, double eta);

} // namespace levelray
