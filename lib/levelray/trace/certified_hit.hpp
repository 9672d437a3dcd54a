// What is proven about a hit, or a miss, of closest_hit: computed on demand, so that rays pay nothing.
//
// f is the trilinear interpolant of the grid's float samples along the true ray o + t d (trace/ray_values),
// times -1 for rays that begin inside. A crossing is certified by two places whose signs are proven; the
// error bound holds for the first root of f, because everything before the bracket is proven to hold none.
//
// How: f(t_lo) > 0 >= f(t_hi) comes from RayValues at places 1, 2, 4, ... of the least steps from the hit's
// t. With e the error of t, a dip of f below 0 that is longer than 2e cannot be jumped over by steps that
// double. That nothing lies before comes from a second walk over the ray's surface cells: Bernstein
// coefficients, halved where needed, above a margin for all rounding. The margin is
//   2^-44 M + 6 M p,   p = 2^-48 (distances in voxels),
// with M the largest sample of the grid: bernstein.hpp's 16 * 2^-53 M, 150 * 2^-53 M for 50 halvings, and the
// walk's ray, which differs from the true one by less than p voxels along each axis (32 * 2^-53 of the
// coordinates: about ten roundings of the origin, its way to the box, and the points of planes), where f
// changes by at most 2 M per voxel and axis. The walk may pass a surface cell by, but for that a sample that
// this cell shares with one without the surface bit must be within 6 M p of 0 without being 0; grids that
// have such samples are looked at once more, cell by cell, wherever the ray is within p of them.
#pragma once

#include "levelray/core/ray.hpp"
#include "levelray/trace/hit.hpp"

#include <cstdint>

namespace levelray {

class LevelSet;

enum class Proof : std::uint8_t {
  crossing,  // f(t_lo) > 0 >= f(t_hi), and no root before t - error
  beginning, // the ray begins on the surface, or within rounding of it: t_lo = t_min, where f > 0 is not
             // proven, and f(t_hi) <= 0 is
  graze,   // f comes within the margin of 0 about t, but no change of sign is proven: a touch, or nearly one;
           // all roots up to t_hi, if there are any, lie within `error` of t
  refuted, // no hit at all: f > 0 on [t_min, clear_to), which reaches voxels beyond t. Never of `exact`
  miss,    // clear_to = t_max: nothing in the interval. Less: f is within the margin of 0 there
};

struct CertifiedHit {
  Proof proof = Proof::miss;
  double t_lo = 0, t_hi = 0; // the bracket; for a graze f > 0 is proven at t_lo, if t_lo > t_min
  double error = 0;          // |t - first root| <= error; infinite for misses and refuted hits
  double clear_to = 0;       // f > 0 on [t_min, clear_to), but for a ray that begins on the surface
};

// Of a hit (or miss) that closest_hit gave for this ray. Hits of any intersector will do: the error is then
// that of its t, however large; a bracket is looked for within two voxels, else it is a graze.
CertifiedHit certify(const LevelSet& level_set, const WorldRay& ray, const Hit& hit);

// Where the surface that the grid was made from lies, if the samples' interpolant is nowhere farther than
// `field_error` (world units, at least 0) from that surface's signed distance (or any field of its signs):
// its first crossing is in [t_lo, t_hi], t_hi infinite where no place within 16 voxels behind the hit is sure
// to lie on the other side. Without a number it is the grid's own field_error, which conversions of closed
// meshes know, sqrt(3)/2 voxels; where that is unknown, the bracket is the ray's whole interval. Fields that
// are smooth have less: h^2 / 8 * (sup |f_xx| + sup |f_yy| + sup |f_zz|), h^2 / (4 R) on a sphere.
struct SurfaceBracket {
  double t_lo = 0, t_hi = 0;
};
SurfaceBracket bracket_original(const LevelSet& level_set, const WorldRay& ray, const Hit& hit,
                                double field_error);
SurfaceBracket bracket_original(const LevelSet& level_set, const WorldRay& ray, const Hit& hit);

} // namespace levelray
